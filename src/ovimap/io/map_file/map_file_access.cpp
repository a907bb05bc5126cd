// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/map_file/map_file_access.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <string>
#include <string_view>
#include <system_error>

#include <SQLiteCpp/SQLiteCpp.h>
#include <fcntl.h>
#include <sqlite3.h>
#include <unistd.h>

#include "ovimap/base/error.h"
#include "ovimap/io/map_file/map_file.h"
#include "ovimap/io/map_file/map_file_guard.h"

namespace ovimap {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kApplication = "OVIM";
constexpr int kApplicationId =
    kApplication[0] << 24 | kApplication[1] << 16 | kApplication[2] << 8 | kApplication[3];
constexpr std::string_view kSqliteMagic("SQLite format 3\0", 16);
constexpr std::size_t kApplicationIdAt = 68;  // bytes from the start of a SQLite file
constexpr std::size_t kReadVersionAt = 19;
constexpr char kReadVersionOfLogs = 2;  // a write-ahead log belongs to the file
constexpr std::array<const char*, 3> kSidecars = {"-journal", "-wal", "-shm"};

fs::path with_suffix(fs::path path, const std::string& suffix) {
  return path += suffix;
}

/// Beside the target, so that renaming stays within one file system; unique among threads and
/// processes.
fs::path temporary_beside(const fs::path& target) {
  static std::atomic<unsigned> counter{0};
  return with_suffix(target, concat(".", ::getpid(), "-", counter.fetch_add(1), ".part"));
}

std::string remedy_for(int error) {
  switch (error) {
    case ENOSPC:
    case EDQUOT:
      return "free some space or choose another disk";
    case EACCES:
    case EPERM:
    case EROFS:
      return "choose a folder that you can write to";
    case ENOENT:
    case ENOTDIR:
      return "create the folder first or choose another";
    case EFBIG:
      return "choose a file system that takes larger files";
    default:
      return "choose another place";
  }
}

[[noreturn]] void fail_to_write(const fs::path& target, int error) {
  throw Error(concat("cannot write map '", target.string(),
                     "': ", std::generic_category().message(error), "; ", remedy_for(error)));
}

/// Flushes a file or folder to disk.
bool flush(const fs::path& path, int flags) {
  const int descriptor = ::open(path.c_str(), flags | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool flushed = ::fsync(descriptor) == 0;
  const int error = errno;
  const bool closed = ::close(descriptor) == 0;
  if (!flushed) errno = error;
  return flushed && closed;
}

/// What the operating system said when SQLite's writing failed; 0 when it was not asked.
int system_error(const SQLite::Database& database, const SQLite::Exception& fault) {
  if (fault.getErrorCode() == SQLITE_FULL) return ENOSPC;
  return fault.getErrorCode() == SQLITE_IOERR ? sqlite3_system_errno(database.getHandle()) : 0;
}

/// Whether something beside the map has not found its way into it.
bool has_log(const fs::path& file) {
  return has_wal(file) || has_journal(file);
}

/// A run's own checkpoint, which lies in its file and the write-ahead log beside it.
bool is_checkpoint(const fs::path& file) {
  return file.extension() == kCheckpointEnding;
}

void mark_as_map(SQLite::Database& database) {
  database.exec(
      concat("PRAGMA application_id = ", kApplicationId, "; PRAGMA user_version = ", kMapSchema));
}

void remove_sidecars(const fs::path& path) {
  for (const char* sidecar : kSidecars) ::unlink(with_suffix(path, sidecar).c_str());
}

/// The file through a URI, for reading.
std::string read_uri(const fs::path& path, bool immutable) {
  static constexpr std::string_view kHex = "0123456789abcdef";
  std::string uri = "file://";
  for (const char c : fs::absolute(path).string()) {
    const auto byte = static_cast<unsigned char>(c);
    const bool plain = std::isalnum(byte) || std::strchr("/._-~", c) != nullptr;
    if (plain)
      uri += c;
    else
      (uri += '%') += {kHex[byte >> 4], kHex[byte & 15]};
  }
  return uri + (immutable ? "?mode=ro&immutable=1" : "?mode=ro");
}

bool is_busy(const SQLite::Exception& fault) {
  return fault.getErrorCode() == SQLITE_BUSY || fault.getErrorCode() == SQLITE_LOCKED;
}

/// Does what the next writer would do with a log that an end cut short: a journal is taken back, a
/// write-ahead log taken in. SQLite's exceptions pass through; throws Error with a phrase when the
/// journal is not of a map.
void settle_log(const fs::path& file) {
  check_journal(file);
  auto database = open_guarded(file.string(), SQLite::OPEN_READWRITE, kLongestValue);
  (void)database->execAndGet("SELECT count(*) FROM sqlite_master").getInt();
  if (database->execAndGet("PRAGMA journal_mode = DELETE").getString() != "delete") return;
  database.reset();
  ::unlink(with_suffix(file, "-wal").c_str());  // SQLite leaves one that holds nothing
}

int pragma(SQLite::Database& database, const char* name) {
  return database.execAndGet(concat("PRAGMA ", name)).getInt();
}

std::unique_ptr<SQLite::Database> open_through(const fs::path& file, bool immutable) {
  constexpr int kPatience_ms = 5000;  // for a change to be written
  auto database = open_guarded(read_uri(file, immutable), SQLite::OPEN_READONLY | SQLite::OPEN_URI,
                               longest_value_in(file), kPatience_ms);
  (void)pragma(*database, "user_version");
  return database;
}

[[noreturn]] void fail_as_cut_short(const fs::path& path, const char* log) {
  throw Error(concat("map '", path.string(), "' was being changed when that was cut short (a ", log,
                     " lies beside it); `ovimap info --recover ", path.string(),
                     "` makes it whole, where you can write to its folder"));
}

bool is_cut_short(const SQLite::Exception& fault) {
  return fault.getExtendedErrorCode() == SQLITE_READONLY_ROLLBACK;
}

/// What lies beside a map is not taken into it by reading: anybody may have put it there. Of a
/// journal SQLite tells whether the change is under way, and then shows the map as it was before.
/// Where locks cannot be had (some network file systems), a file with no log beside it is read
/// without. `logs`: the file says that it has a write-ahead log; with none there, nobody writes.
std::unique_ptr<SQLite::Database> open_for_reading(const fs::path& path, bool logs) {
  const fs::path file = fs::canonical(path);
  if (!is_checkpoint(file)) {
    if (has_wal(file)) fail_as_cut_short(path, "-wal");
    if (logs) return open_through(file, true);
  }
  try {
    return open_through(file, false);
  } catch (const SQLite::Exception& fault) {
    if (is_cut_short(fault) && !has_journal(file))
      return open_through(file, false);  // it was taken back in the meantime
    if (is_cut_short(fault)) fail_as_cut_short(path, "-journal");
    if (is_busy(fault) || has_log(file)) throw;
    return open_through(file, true);
  }
}

/// The file's first bytes, zeros where there are none. Read through SQLite: a handle of our own
/// would, when it is closed, take away the locks that this process has on the file (POSIX).
std::string head_of(const fs::path& file) {
  std::string head(kApplicationIdAt + kApplication.size(), '\0');
  try {
    const SQLite::Database database(read_uri(file, true), SQLite::OPEN_READONLY | SQLite::OPEN_URI);
    sqlite3_file* handle = nullptr;
    sqlite3_file_control(database.getHandle(), "main", SQLITE_FCNTL_FILE_POINTER, &handle);
    if (handle != nullptr && handle->pMethods != nullptr)
      (void)handle->pMethods->xRead(handle, head.data(), static_cast<int>(head.size()), 0);
  } catch (const SQLite::Exception&) {
  }
  return head;
}

/// Throws unless the path is a readable file that begins as SQLite files do. Returns whether it
/// says that it has a write-ahead log.
bool check_file(const fs::path& path) {
  const std::string name = concat("map '", path.string(), "'");
  if (::faccessat(AT_FDCWD, path.c_str(), R_OK, AT_EACCESS) != 0)
    throw Error(concat("cannot open ", name, ": ", std::generic_category().message(errno),
                       "; give a map file that `ovimap run` wrote"));
  if (!fs::is_regular_file(path))
    throw Error(
        concat("'", path.string(), "' is not a file; give a map file that `ovimap run` wrote"));
  const std::string head = head_of(path);
  if (!head.starts_with(kSqliteMagic))
    throw Error(concat("'", path.string(),
                       "' is not an ovimap map; give a map file that `ovimap run` wrote"));
  return head[kReadVersionAt] == kReadVersionOfLogs;
}

/// `fault` may quote the file's own bytes, so what would break the line becomes a blank.
[[noreturn]] void fail_as_damaged(const fs::path& path, std::string fault) {
  std::replace_if(
      fault.begin(), fault.end(), [](unsigned char c) { return std::iscntrl(c) != 0; }, ' ');
  throw DamagedMap(concat("map '", path.string(), "' is damaged: ", fault,
                          "; restore it from a copy or map again"));
}

[[noreturn]] void fail_to_read(const fs::path& path, const SQLite::Exception& fault) {
  if (is_busy(fault))
    throw Error(concat("map '", path.string(),
                       "' is in use by another program; try again when that is done"));
  if (is_cut_short(fault)) fail_as_cut_short(path, "-journal");
  fail_as_damaged(path, fault.what());
}

/// Whether a file holds something that is not a map, which saving must not take away.
bool is_something_else(const fs::path& path) {
  const std::string head = head_of(path);
  return fs::file_size(path) != 0 &&
         (!head.starts_with(kSqliteMagic) || !head.ends_with(kApplication));
}

/// The file that saving to `path` replaces: through a link, what it points to. Devices and pipes
/// must not be renamed away.
fs::path writable_target(const fs::path& path) {
  std::error_code ignored;
  const fs::file_type type = fs::status(path, ignored).type();
  const auto refuse = [&](const char* why) {
    throw Error(concat("cannot write map '", path.string(), "': ", why, "; give a file name"));
  };
  if (!path.has_filename() || type == fs::file_type::directory) refuse("it is a folder");
  if (type == fs::file_type::regular && is_something_else(path)) refuse("it holds no map");
  if (type == fs::file_type::regular) return fs::canonical(path);
  if (type == fs::file_type::not_found && fs::is_symlink(path, ignored))
    refuse("it is a link to nowhere");
  if (type != fs::file_type::not_found && type != fs::file_type::none)
    refuse("it is no plain file");
  return fs::absolute(path);
}

}  // namespace

std::unique_ptr<SQLite::Database> open_growing_map(const fs::path& path) {
  check_journal(path);
  auto database =
      open_guarded(path.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE, kLongestValue);
  // A log written ahead: a transaction that is cut off never was.
  database->exec(
      "PRAGMA page_size = 4096; PRAGMA locking_mode = EXCLUSIVE; PRAGMA journal_mode = WAL; "
      "PRAGMA synchronous = FULL");
  if (pragma(*database, "user_version") == 0) mark_as_map(*database);
  return database;
}

void remove_map(const fs::path& path) {
  ::unlink(path.c_str());
  remove_sidecars(path);
}

void reporting_write_faults(const fs::path& path, const SQLite::Database* database,
                            const std::function<void()>& write) {
  try {
    write();
  } catch (const SQLite::Exception& fault) {
    const int code = fault.getErrorCode();
    if (code == SQLITE_BUSY || code == SQLITE_LOCKED)
      throw Error(concat("map '", path.string(),
                         "' is in use by another program; try again when that is done"));
    if (code == SQLITE_READONLY || code == SQLITE_CANTOPEN || code == SQLITE_PERM)
      fail_to_write(path, EACCES);
    const int error = database ? system_error(*database, fault) : 0;
    if (error != 0) fail_to_write(path, error);
    throw Error(
        concat("cannot write map '", path.string(), "': ", fault.what(), "; choose another place"));
  }
}

PendingMap::PendingMap(const fs::path& target)
    : target_(writable_target(target)), temporary_(temporary_beside(target_)) {
  const int descriptor = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor < 0) fail_to_write(target_, errno);
  ::close(descriptor);
}

PendingMap::~PendingMap() {
  ::unlink(temporary_.c_str());
}  // nothing there after a commit

void PendingMap::write(const std::function<void(SQLite::Database&)>& fill) {
  // No journal and no waiting for the disk: until the commit the file is nobody's.
  SQLite::Database database(temporary_.string(), SQLite::OPEN_READWRITE);
  reporting_write_faults(target_, &database, [&] {
    database.exec(
        "PRAGMA page_size = 4096; PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF; "
        "PRAGMA locking_mode = EXCLUSIVE");
    mark_as_map(database);
    SQLite::Transaction transaction(database);
    fill(database);
    transaction.commit();
  });
}

void PendingMap::commit() {
  if (!flush(temporary_, O_RDWR)) fail_to_write(target_, errno);
  // A log left beside the old map would be taken for the new one's. It is settled first: should the
  // machine stop before the renaming, the old map must be whole without it. One that is none of the
  // old map goes with it.
  try {
    if (has_log(target_)) settle_log(target_);
  } catch (const std::exception&) {
  }
  remove_sidecars(target_);
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail_to_write(target_, errno);
  // Some file systems cannot flush a folder; the map is whole either way.
  (void)flush(target_.parent_path(), O_RDONLY | O_DIRECTORY);
}

bool recover_map(const fs::path& path) {
  (void)check_file(path);
  const fs::path file = fs::canonical(path);
  if (!has_log(file)) return false;
  reporting_write_faults(path, nullptr, [&] {
    try {
      settle_log(file);
    } catch (const Error& fault) {
      throw Error(concat("cannot recover map '", path.string(), "': ", fault.what()));
    }
  });
  return true;
}

OpenMap::OpenMap(const fs::path& path) : path_(path) {
  const bool logs = check_file(path);
  int application = 0;
  try {
    size_bytes_ = fs::file_size(path);
    database_ = open_for_reading(path, logs);
    application = pragma(*database_, "application_id");
    schema_ = pragma(*database_, "user_version");
  } catch (const SQLite::Exception& fault) {
    fail_to_read(path, fault);
  } catch (const Error&) {
    throw;
  } catch (const std::exception& fault) {
    fail_as_damaged(path, fault.what());
  }
  if (application != kApplicationId)
    throw Error(concat("'", path.string(),
                       "' is not an ovimap map but another program's SQLite file; give a map file "
                       "that `ovimap run` wrote"));
  if (schema_ > kMapSchema)
    throw Error(concat("map '", path.string(), "' was written by a newer ovimap (schema ", schema_,
                       ", this program reads up to ", kMapSchema, "); update ovimap"));
  if (schema_ < 1) fail_as_damaged(path, concat("it has schema ", schema_));
}
OpenMap::~OpenMap() = default;

void OpenMap::read(const std::function<void(SQLite::Database&)>& read) {
  read_as_map(path_, *database_, [&](SQLite::Database& database) {
    SQLite::Transaction transaction(database);  // a change meanwhile must not show half-way
    check_schema(database);
    read(database);
    transaction.commit();
  });
}

void read_as_map(const fs::path& path, SQLite::Database& database,
                 const std::function<void(SQLite::Database&)>& read) {
  try {
    read(database);
  } catch (const SQLite::Exception& fault) {
    fail_to_read(path, fault);
  } catch (const Error& fault) {
    fail_as_damaged(path, fault.what());
  }
}

}  // namespace ovimap
