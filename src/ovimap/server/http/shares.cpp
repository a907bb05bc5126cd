// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/http/shares.h"

namespace ovimap {

Shares::Shares(std::size_t all, std::size_t of_one) : all_(all), of_one_(of_one) {}

std::shared_ptr<void> Shares::take(const std::string& client, std::size_t amount) {
  if (amount == 0) return ledger_;
  const std::lock_guard lock(ledger_->mutex);
  const auto found = ledger_->of_client.find(client);
  const std::size_t own = found == ledger_->of_client.end() ? 0 : found->second;
  if (amount > all_ - ledger_->taken || own > of_one_ || amount > of_one_ - own) return nullptr;
  ledger_->taken += amount;
  ledger_->of_client[client] += amount;
  return {ledger_.get(), [ledger = ledger_, client, amount](void*) {
            const std::lock_guard lock_again(ledger->mutex);
            ledger->taken -= amount;
            const auto entry = ledger->of_client.find(client);
            if ((entry->second -= amount) == 0) ledger->of_client.erase(entry);
          }};
}

}  // namespace ovimap
