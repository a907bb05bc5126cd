// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <gtest/gtest.h>

#include "ovimap/base/error.h"

namespace ovimap {

/// The message of the Error that it throws; empty where it throws none.
template <class Action>
std::string fault_of(const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// Likewise; the test fails where it throws none.
template <class Action>
std::string error_of(const Action& action) {
  const std::string fault = fault_of(action);
  if (fault.empty()) ADD_FAILURE() << "no error was thrown";
  return fault;
}

}  // namespace ovimap
