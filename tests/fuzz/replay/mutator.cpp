#include "tests/fuzz/replay/mutator.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace overfly::fuzz {
namespace {

constexpr std::size_t kLongestInput = 16U << 10U;
constexpr std::size_t kLongestPiece = 256;

constexpr std::array<const char*, 12> kExtremeNumbers = {"0",
                                                         "-1",
                                                         "2147483648",
                                                         "4294967296",
                                                         "9223372036854775807",
                                                         "18446744073709551616",
                                                         "1e308",
                                                         "-1e-9",
                                                         "1e999",
                                                         "nan",
                                                         "-inf",
                                                         "0.1e+"};

bool is_digit(char c) { return c >= '0' && c <= '9'; }

}  // namespace

Mutator::Mutator(std::vector<std::string> seeds, std::vector<std::string> words)
    : seeds_(std::move(seeds)), words_(std::move(words)) {}

std::string Mutator::next() {
  std::string input = seeds_[below(seeds_.size())];
  // Mostly few: what follows the first error in a text is not read.
  for (std::size_t changes = 1 + below(1 + below(8)); changes > 0; --changes) change(&input);
  input.resize(std::min(input.size(), kLongestInput));
  return input;
}

std::size_t Mutator::below(std::size_t bound) { return bound == 0 ? 0 : random_() % bound; }

void Mutator::change(std::string* input) {
  switch (below(6)) {
    case 0:
      return replace_byte(input);
    case 1:
      return cut_piece(input);
    case 2:
      return double_piece(input);
    case 3:
      return take_piece_of_another(input);
    case 4:
      return put_in_word(input);
    default:
      return replace_number(input);
  }
}

void Mutator::replace_byte(std::string* input) {
  if (input->empty()) return;
  char& byte = (*input)[below(input->size())];
  byte = below(2) == 0 ? static_cast<char>(byte ^ (1 << below(8))) : static_cast<char>(below(256));
}

void Mutator::cut_piece(std::string* input) {
  const std::size_t begin = below(input->size());
  // Now and then all that follows, as a file that was not written to its end.
  input->erase(begin, below(8) == 0 ? std::string::npos : 1 + below(kLongestPiece));
}

void Mutator::double_piece(std::string* input) {
  const std::string piece = input->substr(below(input->size()), 1 + below(kLongestPiece));
  input->insert(below(input->size() + 1), piece);
}

void Mutator::take_piece_of_another(std::string* input) {
  const std::string& other = seeds_[below(seeds_.size())];
  const std::string piece = other.substr(below(other.size()), 1 + below(kLongestPiece));
  const std::size_t begin = below(input->size() + 1);
  input->replace(begin, below(2) == 0 ? 0 : piece.size(), piece);
}

void Mutator::put_in_word(std::string* input) {
  if (words_.empty()) return;
  const std::string& word = words_[below(words_.size())];
  const std::size_t begin = below(input->size() + 1);
  input->replace(begin, below(2) == 0 ? 0 : word.size(), word);
}

void Mutator::replace_number(std::string* input) {
  const auto from = input->begin() + static_cast<std::ptrdiff_t>(below(input->size()));
  const auto begin = std::find_if(from, input->end(), is_digit);
  const auto end = std::find_if_not(begin, input->end(), is_digit);
  if (begin == end) return;
  input->replace(begin, end, kExtremeNumbers[below(kExtremeNumbers.size())]);
}

}  // namespace overfly::fuzz
