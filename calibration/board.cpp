#include "calibration/board.hpp"

#include <charconv>
#include <cmath>

#include "calibration/marker_dictionary.hpp"
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

Status check_markers(const Board& board) {
  const BoardMarkers& markers = *board.markers;
  const auto bad = [](const std::string& what) { return Error{ErrorCode::kInvalidArgument, what}; };
  if (markers.bits < 4 || markers.bits > 6) {
    return bad("marker bits = " + std::to_string(markers.bits) + ": must be 4, 5 or 6");
  }
  const double part = markers.side_m / board.square_m;
  if (!(part >= 0.3 && part <= 0.9)) {
    return bad("marker_m = " + number_text(markers.side_m) +
               ": must be 0.3 to 0.9 times square_m = " + number_text(board.square_m));
  }
  if (board.marker_count() <= kDictionaryMarkers) return {};
  return bad("board " + size_text(board.cols, board.rows) + ": has " +
             std::to_string(board.marker_count()) + " markers, must have at most " +
             std::to_string(kDictionaryMarkers));
}

}  // namespace

Status Board::validate() const {
  if (Status status = check_side("columns", cols); !status) return status;
  if (Status status = check_side("rows", rows); !status) return status;
  if (!(square_m > 0.0 && square_m <= kMostSquareM)) {
    return Error{ErrorCode::kInvalidArgument,
                 "square_m = " + number_text(square_m) + ": must be in (0, 10]"};
  }
  return markers ? check_markers(*this) : Status();
}

// A row of W squares begins with a dark square if its number is even, so that two rows have W
// bright squares together.
Eigen::Vector2i Board::marker_square(int id) const {
  const int width = cols + 1;
  const int in_pair = id % width;
  const bool second = in_pair >= width / 2;
  const int row = 2 * (id / width) + (second ? 1 : 0);
  const int col = second ? 2 * (in_pair - width / 2) : 2 * in_pair + 1;
  return {col - 1, row - 1};
}

std::optional<int> Board::marker_of(int i, int j) const {
  const int col = i + 1;
  const int row = j + 1;
  if (col < 0 || row < 0 || col > cols || row > rows || (col + row) % 2 == 0) return std::nullopt;
  const int width = cols + 1;
  return row / 2 * width + (row % 2 == 0 ? 0 : width / 2) + col / 2;
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
