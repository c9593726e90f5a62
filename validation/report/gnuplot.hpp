// Words of gnuplot programs. Text that comes from files is quoted so that gnuplot runs nothing in it.
#pragma once
#include <string>
#include <vector>

namespace weir::validation::gnuplot {

/// Okabe & Ito 2008: distinguishable by colour-blind readers too.
inline constexpr const char* colours[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000", "#999999"};

/// Width of a letter [pixels] of the font of this size; wide enough for most texts.
double letter_width(double font_size);

/// A text of a program. Within double quotes gnuplot runs what stands between back quotes; within single quotes nothing is replaced, and
/// a single quote stands as two.
std::string quoted(const std::string& text);
/// A text of a data block, which knows double quotes only, has no sign for one within, and runs nothing.
std::string quoted_datum(std::string text);
/// Words in lines of at most `most` letters.
std::vector<std::string> lines_of(const std::string& text, std::size_t most);

/// Pixels of a figure as gnuplot's screen coordinates.
struct Paper {
    double width, height;
    double x(double px) const { return px / width; }
    double y(double px) const { return 1 - px / height; }
};
/// "set label TEXT at screen X,Y" with its options.
std::string label(const Paper& paper, const std::string& text, double x, double y, const std::string& options);
/// The margins of a panel: its axes from left to right and from top to bottom [pixels].
std::string margins(const Paper& paper, double left, double right, double top, double bottom);

}  // namespace weir::validation::gnuplot
