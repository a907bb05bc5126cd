// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/hub/transfer/git_blob.h"

#include <openssl/evp.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "ovimap/base/error.h"

namespace ovimap {

namespace fs = std::filesystem;

std::string git_blob_of_file(const fs::path& file) {
  const std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> sha(EVP_MD_CTX_new(), EVP_MD_CTX_free);
  if (!sha || EVP_DigestInit_ex(sha.get(), EVP_sha1(), nullptr) != 1)
    throw Error("OpenSSL offers no SHA-1; check its configuration (openssl.cnf)");
  const std::string head = concat("blob ", fs::file_size(file));
  EVP_DigestUpdate(sha.get(), head.c_str(), head.size() + 1);
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> in(std::fopen(file.c_str(), "rb"),
                                                           std::fclose);
  if (!in) throw Error(concat("cannot read ", file.string(), ": ", std::strerror(errno)));
  char piece[1 << 16];
  while (const std::size_t size = std::fread(piece, 1, sizeof piece, in.get()))
    EVP_DigestUpdate(sha.get(), piece, size);
  unsigned char digest[EVP_MAX_MD_SIZE];
  unsigned size = 0;
  EVP_DigestFinal_ex(sha.get(), digest, &size);
  std::string hex;
  for (unsigned i = 0; i < size; ++i) {
    hex += "0123456789abcdef"[digest[i] >> 4];
    hex += "0123456789abcdef"[digest[i] & 15];
  }
  return hex;
}

}  // namespace ovimap
