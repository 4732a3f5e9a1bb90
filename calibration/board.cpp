#include "calibration/board.hpp"

#include <charconv>
#include <cmath>

#include "core/text/number_text.hpp"

namespace overfly::calibration {
namespace {

constexpr int kLeastCorners = 3;  // OpenCV's detector needs three
constexpr int kMostCorners = 60;
constexpr double kMostSquareM = 10.0;

std::string size_text(int cols, int rows) {
  return std::to_string(cols) + "x" + std::to_string(rows);
}

Status check_side(const char* side, int corners) {
  if (corners >= kLeastCorners && corners <= kMostCorners) return {};
  return Error{ErrorCode::kInvalidArgument,
               std::string("board: ") + side + " = " + std::to_string(corners) +
                   " inner corners: must be in [3, 60]"};
}

}  // namespace

Status Board::validate() const {
  if (Status status = check_side("columns", cols); !status) return status;
  if (Status status = check_side("rows", rows); !status) return status;
  if (square_m > 0.0 && square_m <= kMostSquareM) return {};
  return Error{ErrorCode::kInvalidArgument,
               "square_m = " + number_text(square_m) + ": must be in (0, 10]"};
}

Result<Board> board_from_text(const std::string& text, double square_m) {
  Board board;
  board.square_m = square_m;
  const char* const end = text.data() + text.size();
  const auto cols = std::from_chars(text.data(), end, board.cols);
  const bool first = cols.ec == std::errc() && cols.ptr != end && *cols.ptr == 'x';
  const auto rows = first ? std::from_chars(cols.ptr + 1, end, board.rows) : cols;
  if (!first || rows.ec != std::errc() || rows.ptr != end) {
    return Error{ErrorCode::kInvalidArgument,
                 "board = " + text + ": must be COLSxROWS, the numbers of inner corners, e.g. 9x6"};
  }
  if (Status status = board.validate(); !status) return status.error();
  return board;
}

Status require_unambiguous(const Board& board) {
  if (!board.half_turn_symmetric()) return {};
  return Error{
      ErrorCode::kInvalidArgument,
      "board " + size_text(board.cols, board.rows) +
          " looks the same after half a turn, because its numbers of inner corners are "
          "both " +
          (board.cols % 2 == 0 ? "even" : "odd") + ": use one odd and one even number, as " +
          size_text(board.cols + 1, board.rows) + " or " + size_text(board.cols, board.rows + 1)};
}

}  // namespace overfly::calibration
