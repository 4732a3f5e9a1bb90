// Inputs near those of a corpus, the same ones in every run.
#pragma once

#include <cstddef>
#include <random>
#include <string>
#include <vector>

namespace overfly::fuzz {

/// Changes inputs at random places: bytes flipped and replaced, pieces cut, doubled, exchanged and
/// taken from another input, words of a dictionary and extreme numbers put in.
class Mutator {
 public:
  /// `seeds` are the inputs to begin with, at least one; `words` may be empty. The same arguments
  /// make the same inputs.
  Mutator(std::vector<std::string> seeds, std::vector<std::string> words);

  /// The next input: one of the seeds after one to eight changes, of at most 16 KiB.
  [[nodiscard]] std::string next();

 private:
  /// A number below `bound`; 0 for a bound of 0.
  [[nodiscard]] std::size_t below(std::size_t bound);
  void change(std::string* input);
  void replace_byte(std::string* input);
  void cut_piece(std::string* input);
  void double_piece(std::string* input);
  void take_piece_of_another(std::string* input);
  void put_in_word(std::string* input);
  void replace_number(std::string* input);

  std::vector<std::string> seeds_;
  std::vector<std::string> words_;
  std::mt19937_64 random_{1};
};

}  // namespace overfly::fuzz
