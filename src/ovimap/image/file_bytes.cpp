// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "ovimap/image/codec.h"
#include "ovimap/image/scratch_file.h"

namespace ovimap {

namespace {

std::string reason(int error) {
  return std::generic_category().message(error);
}

std::string remedy_for(int error) {
  switch (error) {
    case ENOSPC:
    case EDQUOT:
      return "free some space or choose another disk";
    case ENOENT:
    case ENOTDIR:
      return "create the folder first or choose another";
    default:
      return "choose a place that you can write to";
  }
}

[[noreturn]] void fail_to_write(const std::filesystem::path& path, int error) {
  throw Error(concat("cannot write ", path.string(), ": ", reason(error), "; ", remedy_for(error)));
}

class Descriptor {
 public:
  Descriptor(const std::filesystem::path& path, int flags)
      : fd_(::open(path.c_str(), flags | O_CLOEXEC, 0666)) {}
  ~Descriptor() { (void)close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int get() const { return fd_; }
  /// Some file systems report a full disk only here.
  bool close() {
    const int fd = fd_;
    fd_ = -1;
    return fd < 0 || ::close(fd) == 0;
  }

 private:
  int fd_;
};

/// Beside `path`, so that renaming stays within one file system; unique among threads and
/// processes.
std::filesystem::path temporary_beside(const std::filesystem::path& path) {
  static std::atomic<unsigned> counter{0};
  std::filesystem::path temporary = path;
  temporary += concat(".", ::getpid(), "-", counter.fetch_add(1), ".part");
  return temporary;
}

void refuse_folder(const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored))
    throw Error(concat("cannot write ", path.string(), ": it is a folder, give a file name"));
}

bool write_all(int fd, std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(fd, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return true;
}

bool copy_all(const ScratchFile& scratch, int fd) {
  constexpr std::uint64_t kAtOnce = 1 << 20;
  Bytes piece;
  for (std::uint64_t done = 0; done < scratch.size(); done += piece.size()) {
    piece.resize(std::min(kAtOnce, scratch.size() - done));
    scratch.read(done, piece);
    if (!write_all(fd, piece)) return false;
  }
  return true;
}

}  // namespace

Bytes read_file(const std::filesystem::path& path) {
  const Descriptor file(path, O_RDONLY | O_NONBLOCK);  // a pipe in its place would hold us up
  if (file.get() < 0) throw Error(concat("cannot open ", path.string(), ": ", reason(errno)));
  struct stat status {};
  if (::fstat(file.get(), &status) != 0)
    throw Error(concat("cannot read ", path.string(), ": ", reason(errno)));
  if (S_ISDIR(status.st_mode)) throw Error(concat(path.string(), " is a folder, expected a file"));
  if (!S_ISREG(status.st_mode))
    throw Error(concat(path.string(), " is a device or a pipe, expected a file"));

  // One byte more than the size told, so that the end is met without growing.
  Bytes bytes(static_cast<std::size_t>(status.st_size) + 1);
  std::size_t length = 0;
  while (true) {
    const ssize_t got = ::read(file.get(), bytes.data() + length, bytes.size() - length);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw Error(concat("cannot read ", path.string(), ": ", reason(errno)));
    if (got == 0) break;
    length += static_cast<std::size_t>(got);
    if (length == bytes.size()) bytes.resize(2 * bytes.size());
  }
  bytes.resize(length);
  return bytes;
}

void check_file_target(const std::filesystem::path& path) {
  refuse_folder(path);
  const std::filesystem::path temporary = temporary_beside(path);
  const Descriptor file(temporary, O_WRONLY | O_CREAT | O_EXCL);
  if (file.get() < 0) fail_to_write(path, errno);
  ::unlink(temporary.c_str());
}

void write_file(const std::filesystem::path& path, std::span<const std::uint8_t> bytes) {
  write_file(path, bytes, {});
}

void write_file(const std::filesystem::path& path, std::span<const std::uint8_t> head,
                std::initializer_list<const ScratchFile*> rest) {
  refuse_folder(path);
  const std::filesystem::path temporary = temporary_beside(path);
  Descriptor file(temporary, O_WRONLY | O_CREAT | O_EXCL);
  if (file.get() < 0) fail_to_write(path, errno);
  try {
    bool complete = write_all(file.get(), head);
    for (const ScratchFile* scratch : rest) complete = complete && copy_all(*scratch, file.get());
    complete = complete && file.close();
    if (!complete || ::rename(temporary.c_str(), path.c_str()) != 0) fail_to_write(path, errno);
  } catch (...) {  // also of a scratch file that cannot be read back
    ::unlink(temporary.c_str());
    throw;
  }
}

ScratchFile::ScratchFile(const std::filesystem::path& target) : target_(target) {
  refuse_folder(target);
  const std::filesystem::path name = temporary_beside(target);
  fd_ = ::open(name.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (fd_ < 0) fail_to_write(target, errno);
  ::unlink(name.c_str());
}

ScratchFile::~ScratchFile() {
  ::close(fd_);
}

void ScratchFile::append(std::span<const std::uint8_t> bytes) {
  if (!write_all(fd_, bytes)) fail_to_write(target_, errno);
  size_ += bytes.size();
}

void ScratchFile::read(std::uint64_t offset, std::span<std::uint8_t> bytes) const {
  OVIMAP_ASSERT(offset + bytes.size() <= size_);
  while (!bytes.empty()) {
    const ssize_t got = ::pread(fd_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0)
      throw Error(concat("cannot read back what is to go into ", target_.string(), ": ",
                         got < 0 ? reason(errno) : "somebody made it shorter"));
    offset += static_cast<std::uint64_t>(got);
    bytes = bytes.subspan(static_cast<std::size_t>(got));
  }
}

void write_text(const std::filesystem::path& path, std::string_view text) {
  write_file(path, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

}  // namespace ovimap
