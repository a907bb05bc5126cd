// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0

// A block of LZFSE's own kind: literals, and triplets of literal run, match length and distance,
// both coded by table-driven asymmetric numeral systems whose tables stand in the header.
#include <array>
#include <bit>

#include "ovimap/frames/decoding/lzfse_blocks.h"

namespace ovimap::lzfse {

namespace {

constexpr std::size_t kLengthSymbols = 20, kDistanceSymbols = 64, kLiteralSymbols = 256;
constexpr std::uint32_t kLengthStates = 64, kDistanceStates = 256, kLiteralStates = 1024;
constexpr std::size_t kInterleaved = 4;  ///< states that take turns at literals

/// Extra bits behind each symbol of a literal run and a match length.
constexpr std::array<std::uint8_t, kLengthSymbols> kRunBits = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
                                                               0, 0, 0, 0, 0, 0, 2, 3, 5, 8};
constexpr std::array<std::uint8_t, kLengthSymbols> kMatchBits = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
                                                                 0, 0, 0, 0, 0, 0, 3, 5, 8, 11};

std::uint32_t field(std::uint64_t packed, int first, int count) {
  return static_cast<std::uint32_t>((packed >> first) & ((std::uint64_t{1} << count) - 1));
}

/// Reads numbers from the end of the bytes towards their begin, as the coder wrote them last.
class BackwardBits {
 public:
  /// `unused`: how many of the highest bits hold nothing.
  BackwardBits(Input bytes, std::uint32_t unused) : bytes_(bytes), left_(8 * bytes.size()) {
    if (unused > left_) fail_broken();
    left_ -= unused;
  }

  std::uint32_t read(unsigned count) {
    if (count > left_) fail_broken();
    left_ -= count;
    std::uint64_t window = 0;
    const std::size_t first = left_ / 8, last = (left_ + count + 7) / 8;
    for (std::size_t i = first; i < last; ++i)
      window |= static_cast<std::uint64_t>(bytes_[i]) << (8 * (i - first));
    return field(window, static_cast<int>(left_ % 8), static_cast<int>(count));
  }

 private:
  Input bytes_;
  std::size_t left_;  ///< bits
};

/// One state: what it stands for, and how the next state is read.
struct Entry {
  std::uint8_t symbol = 0, bits = 0;
  std::uint16_t base = 0;
};

/// The states of a decoder, in order of their symbols. Short when not all states are in use.
class Table {
 public:
  Table(std::span<const std::uint16_t> frequencies, std::uint32_t states) {
    entries_.reserve(states);
    for (std::size_t symbol = 0; symbol < frequencies.size(); ++symbol) {
      const std::uint32_t frequency = frequencies[symbol];
      if (frequency == 0) continue;
      if (frequency > states - entries_.size()) fail_broken();
      add_symbol(static_cast<std::uint8_t>(symbol), frequency, states);
    }
  }

  const Entry& at(std::uint32_t state) const {
    if (state >= entries_.size()) fail_broken();
    return entries_[state];
  }

 private:
  /// A symbol's states share out [0, states): some read `bits`, the others one bit less.
  void add_symbol(std::uint8_t symbol, std::uint32_t frequency, std::uint32_t states) {
    const int bits = std::bit_width(states) - std::bit_width(frequency);
    const std::uint32_t wide = ((2 * states) >> bits) - frequency;
    for (std::uint32_t i = 0; i < frequency; ++i) {
      const bool is_wide = i < wide;
      const std::uint32_t base =
          is_wide ? ((frequency + i) << bits) - states : (i - wide) << (bits - 1);
      entries_.push_back({symbol, static_cast<std::uint8_t>(is_wide ? bits : bits - 1),
                          static_cast<std::uint16_t>(base)});
    }
  }

  std::vector<Entry> entries_;
};

std::uint8_t read_symbol(const Table& table, std::uint32_t& state, BackwardBits& bits) {
  const Entry& entry = table.at(state);
  state = entry.base + bits.read(entry.bits);
  return entry.symbol;
}

/// Decodes numbers whose symbols stand for ranges, each of which begins where the last one ends.
class NumberDecoder {
 public:
  NumberDecoder(std::span<const std::uint16_t> frequencies, std::uint32_t states,
                std::span<const std::uint8_t> extra_bits, std::uint32_t first_state)
      : table_(frequencies, states), extra_bits_(extra_bits), state_(first_state) {
    std::uint32_t begin = 0;
    for (const std::uint8_t bits : extra_bits) {
      begins_.push_back(begin);
      begin += std::uint32_t{1} << bits;
    }
  }

  std::uint32_t read(BackwardBits& bits) {
    const std::uint8_t symbol = read_symbol(table_, state_, bits);
    return begins_[symbol] + bits.read(extra_bits_[symbol]);
  }

 private:
  Table table_;
  std::span<const std::uint8_t> extra_bits_;
  std::vector<std::uint32_t> begins_;
  std::uint32_t state_;
};

struct Header {
  std::uint32_t raw_size = 0;
  std::uint32_t literals = 0, literal_bytes = 0, literal_unused = 0;
  std::uint32_t triplets = 0, triplet_bytes = 0, triplet_unused = 0;
  std::array<std::uint32_t, kInterleaved> literal_states{};
  std::uint32_t run_state = 0, match_state = 0, distance_state = 0;
  std::array<std::uint16_t, kLengthSymbols> run_frequencies{}, match_frequencies{};
  std::array<std::uint16_t, kDistanceSymbols> distance_frequencies{};
  std::array<std::uint16_t, kLiteralSymbols> literal_frequencies{};
};

/// Takes frequencies off a string of bits that begins at the lowest; small ones are short.
class FrequencyReader {
 public:
  explicit FrequencyReader(Input bytes) : bytes_(bytes) {}

  void read(std::span<std::uint16_t> frequencies) {
    for (std::uint16_t& frequency : frequencies) frequency = read_one();
  }
  bool is_at_end() const { return used_ <= 8 * bytes_.size() && 8 * bytes_.size() - used_ < 8; }

 private:
  std::uint16_t read_one() {
    const std::uint32_t window = peek();
    if ((window & 1) == 0) return take(window, 2, 1, 0);
    if ((window & 3) == 1) return take(window, 3, 2, 2);
    if ((window & 7) == 3) return take(window, 5, 3, 4);
    if ((window & 15) == 7) return take(window, 8, 4, 8);
    return take(window, 14, 4, 24);
  }
  /// A code of `size` bits whose number stands from bit `first` on.
  std::uint16_t take(std::uint32_t window, int size, int first, int base) {
    used_ += static_cast<std::size_t>(size);
    return static_cast<std::uint16_t>(field(window, first, size - first) +
                                      static_cast<std::uint32_t>(base));
  }
  /// The next 14 bits; zeros behind the end, where is_at_end tells.
  std::uint32_t peek() const {
    std::uint32_t window = 0;
    for (std::size_t i = 0; i < 3 && used_ / 8 + i < bytes_.size(); ++i)
      window |= static_cast<std::uint32_t>(bytes_[used_ / 8 + i]) << (8 * i);
    return window >> (used_ % 8);
  }

  Input bytes_;
  std::size_t used_ = 0;  ///< bits
};

void read_frequencies(Input bytes, Header& header) {
  if (bytes.empty()) return;
  FrequencyReader reader(bytes);
  reader.read(header.run_frequencies);
  reader.read(header.match_frequencies);
  reader.read(header.distance_frequencies);
  reader.read(header.literal_frequencies);
  if (!reader.is_at_end()) fail_broken();
}

Header read_header(Input& input) {
  constexpr std::uint32_t kFixedSize = 32;  ///< with the four letters
  Header header;
  header.raw_size = take_number<std::uint32_t>(input);
  const auto first = take_number<std::uint64_t>(input), second = take_number<std::uint64_t>(input),
             third = take_number<std::uint64_t>(input);
  header.literals = field(first, 0, 20);
  header.literal_bytes = field(first, 20, 20);
  header.triplets = field(first, 40, 20);
  header.literal_unused = 7 - field(first, 60, 3);
  for (std::size_t i = 0; i < kInterleaved; ++i)
    header.literal_states[i] = field(second, static_cast<int>(10 * i), 10);
  header.triplet_bytes = field(second, 40, 20);
  header.triplet_unused = 7 - field(second, 60, 3);
  header.run_state = field(third, 32, 10);
  header.match_state = field(third, 42, 10);
  header.distance_state = field(third, 52, 10);
  const std::uint32_t header_size = field(third, 0, 32);
  if (header_size < kFixedSize) fail_broken();
  read_frequencies(take(input, header_size - kFixedSize), header);
  return header;
}

std::vector<std::uint8_t> read_literals(const Header& header, Input bytes) {
  if (header.literals % kInterleaved != 0) fail_broken();
  const Table table(header.literal_frequencies, kLiteralStates);
  BackwardBits bits(bytes, header.literal_unused);
  std::array<std::uint32_t, kInterleaved> states = header.literal_states;
  std::vector<std::uint8_t> literals(header.literals);
  for (std::size_t i = 0; i < literals.size(); ++i)
    literals[i] = read_symbol(table, states[i % kInterleaved], bits);
  return literals;
}

std::array<std::uint8_t, kDistanceSymbols> distance_bits() {
  std::array<std::uint8_t, kDistanceSymbols> bits{};
  for (std::size_t i = 0; i < bits.size(); ++i) bits[i] = static_cast<std::uint8_t>(i / 4);
  return bits;
}

}  // namespace

void decode_entropy_block(Input& input, Output& output) {
  const Header header = read_header(input);
  const std::vector<std::uint8_t> literals =
      read_literals(header, take(input, header.literal_bytes));
  static const std::array<std::uint8_t, kDistanceSymbols> kDistanceBits = distance_bits();
  NumberDecoder runs(header.run_frequencies, kLengthStates, kRunBits, header.run_state);
  NumberDecoder matches(header.match_frequencies, kLengthStates, kMatchBits, header.match_state);
  NumberDecoder distances(header.distance_frequencies, kDistanceStates, kDistanceBits,
                          header.distance_state);
  BackwardBits bits(take(input, header.triplet_bytes), header.triplet_unused);
  const std::size_t begin = output.size();
  Input unread = literals;
  std::size_t distance = 0;
  for (std::uint32_t i = 0; i < header.triplets; ++i) {
    const std::uint32_t run = runs.read(bits), length = matches.read(bits);
    const std::uint32_t stored_distance = distances.read(bits);
    if (stored_distance > 0) distance = stored_distance;  // 0: the last one again
    output.append(take(unread, run));
    output.repeat(distance, length);
  }
  if (output.size() - begin != header.raw_size) fail_broken();
}

}  // namespace ovimap::lzfse
