// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/map_tables/map_file_rows.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include <SQLiteCpp/SQLiteCpp.h>
#include <xxhash.h>

namespace ovimap {

namespace {

int column_count(const MapTable& table) {
  const std::string_view columns = table.columns;
  return 1 + static_cast<int>(std::count(columns.begin(), columns.end(), ','));
}

std::string insert_sql(const MapTable& table) {
  std::string sql = concat("INSERT INTO ", table.name, " (", table.columns, ") VALUES (?");
  for (int i = 1; i < column_count(table); ++i) sql += ", ?";
  return sql + ")";
}

}  // namespace

void create_table(SQLite::Database& database, const MapTable& table) {
  database.exec(concat("CREATE TABLE IF NOT EXISTS ", table.name, " (", table.definition, ") ",
                       table.options));
}

bool has_table(SQLite::Database& database, const MapTable& table) {
  return database.tableExists(table.name);
}

bool holds_table(SQLite::Database& database, const MapTable& table) {
  if (has_table(database, table)) return true;
  if (!has_table(database, map_tables::kChecks)) return false;
  SQLite::Statement check(database, "SELECT 1 FROM checks WHERE name = ?");
  check.bind(1, table.name);
  if (check.executeStep()) throw Error(concat("table ", table.name, " is missing"));
  return false;
}

void drop_table(SQLite::Database& database, const MapTable& table) {
  if (!has_table(database, table)) return;
  database.exec(concat("DROP TABLE ", table.name));
  SQLite::Statement check(database, "DELETE FROM checks WHERE name = ?");
  check.bind(1, table.name);
  check.exec();
}

void write_check(SQLite::Database& database, const MapTable& table, std::int64_t rows,
                 std::int64_t hash) {
  create_table(database, map_tables::kChecks);
  SQLite::Statement check(database, insert_sql(map_tables::kChecks));
  check.bind(1, table.name);
  check.bind(2, rows);
  check.bind(3, hash);
  check.exec();
}

std::int64_t stored_hash(std::span<const std::uint8_t> bytes) {
  return static_cast<std::int64_t>(XXH64(bytes.data(), bytes.size(), 0));
}

void TableHash::add_word(char type, std::uint64_t word) {
  row_.push_back(static_cast<std::uint8_t>(type));
  for (int i = 0; i < 8; ++i) row_.push_back(static_cast<std::uint8_t>(word >> 8 * i));
}

void TableHash::add_bytes(char type, const void* data, std::size_t size) {
  add_word(type, size);
  const auto* bytes = static_cast<const std::uint8_t*>(data);
  row_.insert(row_.end(), bytes, bytes + size);
}

void TableHash::add(std::int64_t value) {
  add_word('i', static_cast<std::uint64_t>(value));
}
void TableHash::add(double value) {
  if (std::isnan(value))
    add_word('n', 0);
  else
    add_word('r', std::bit_cast<std::uint64_t>(value == 0 ? 0.0 : value));
}
void TableHash::add(std::string_view value) {
  add_bytes('t', value.data(), value.size());
}
void TableHash::add(std::span<const std::uint8_t> value) {
  add_bytes('b', value.data(), value.size());
}

void TableHash::end_row() {
  sum_ += XXH64(row_.data(), row_.size(), 0);
  ++rows_;
  row_.clear();
}

RowWriter::RowWriter(SQLite::Database& database, const MapTable& table)
    : database_(database), table_(table) {
  create_table(database, table);
  statement_ = std::make_unique<SQLite::Statement>(database, insert_sql(table));
}
RowWriter::~RowWriter() = default;

void RowWriter::bind_integer(std::int64_t value) {
  hash_.add(value);
  statement_->bind(++column_, value);
}

void RowWriter::bind_real(double value) {
  hash_.add(value);
  statement_->bind(++column_, value);  // SQLite turns NaN into NULL
}

void RowWriter::bind(const std::string& value) {
  hash_.add(std::string_view(value));
  statement_->bindNoCopy(++column_, value);
}

void RowWriter::bind(std::span<const std::uint8_t> value) {
  // SQLite would take the null pointer of an empty span for NULL.
  static constexpr std::uint8_t kNothing = 0;
  hash_.add(value);
  statement_->bindNoCopy(++column_, value.empty() ? &kNothing : value.data(),
                         static_cast<int>(value.size()));
}

void RowWriter::end_row() {
  OVIMAP_ASSERT(column_ == column_count(table_));
  hash_.end_row();
  statement_->exec();
  statement_->reset();
  column_ = 0;
}

void RowWriter::finish() {
  write_check(database_, table_, hash_.rows(), hash_.sum());
}

void verify_table(SQLite::Database& database, const MapTable& table) {
  RowReader rows(database, table);
  while (rows.next()) rows.skip();
}

RowReader::RowReader(SQLite::Database& database, const MapTable& table)
    : database_(database),
      table_(table),
      statement_(std::make_unique<SQLite::Statement>(
          database, concat("SELECT ", table.columns, " FROM ", table.name, " ORDER BY 1, 2"))) {}
RowReader::~RowReader() = default;

bool RowReader::next() {
  if (column_ >= 0) {
    OVIMAP_ASSERT(column_ == column_count(table_));
    hash_.end_row();
  }
  column_ = 0;
  if (statement_->executeStep()) return true;
  verify();
  return false;
}

int RowReader::take_column(int type) {
  const int found = statement_->getColumn(column_).getType();
  if (found != type) fail(concat("holds a value of the wrong type in column ", column_ + 1));
  return column_++;
}

std::int64_t RowReader::integer_value() {
  const std::int64_t value = statement_->getColumn(take_column(SQLite::INTEGER)).getInt64();
  hash_.add(value);
  return value;
}

double RowReader::real() {
  const bool absent = statement_->getColumn(column_).isNull();
  const int column = take_column(absent ? SQLite::Null : SQLite::FLOAT);
  const double value =
      absent ? std::numeric_limits<double>::quiet_NaN() : statement_->getColumn(column).getDouble();
  hash_.add(value);
  return value;
}

std::string RowReader::text() {
  std::string value = statement_->getColumn(take_column(SQLite::TEXT)).getString();
  hash_.add(std::string_view(value));
  return value;
}

std::span<const std::uint8_t> RowReader::blob() {
  const SQLite::Column column = statement_->getColumn(take_column(SQLite::BLOB));
  const std::span value(static_cast<const std::uint8_t*>(column.getBlob()),
                        static_cast<std::size_t>(column.getBytes()));
  hash_.add(value);
  return value;
}

void RowReader::skip() {
  while (column_ < column_count(table_)) {
    const int type = statement_->getColumn(column_).getType();
    if (type == SQLite::INTEGER)
      (void)integer_value();
    else if (type == SQLite::TEXT)
      (void)text();
    else if (type == SQLite::BLOB)
      (void)blob();
    else
      (void)real();
  }
}

void RowReader::verify() {
  SQLite::Statement check(database_, "SELECT rows, hash FROM checks WHERE name = ?");
  check.bind(1, table_.name);
  if (!check.executeStep()) fail("has no check");
  const std::int64_t rows = check.getColumn(0).getInt64(), sum = check.getColumn(1).getInt64();
  if (rows != hash_.rows())
    fail(concat("has ", hash_.rows(), " rows, but ", rows, " were written"));
  if (sum != hash_.sum()) fail("is not what was written");
}

void RowReader::fail(const std::string& fault) const {
  throw Error(concat("table ", table_.name, " ", fault));
}

}  // namespace ovimap
