// Suggestions for misspelt names.
#pragma once
#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace weir::scene {

/// Fewest insertions, deletions, replacements and swaps of neighbours that turn one word into the other, no letter being changed twice
/// (Damerau 1964; Levenshtein 1966; the "optimal string alignment" variant). Letters' case costs nothing.
int edit_distance(std::string_view a, std::string_view b);

/// The name nearest to `word`, if it is close enough: at most one mistake per three letters. Empty: none.
std::string nearest(std::string_view word, const std::vector<std::string>& names);

/// `; did you mean "x"?` or nothing.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& names);
/// `known: a, b, c`, shortened beyond a line's length.
std::string known(const std::vector<std::string>& names);
std::string quote(std::string_view text);                      // "text", control characters escaped, long texts cut
std::string quote_all(const std::vector<std::string>& names);  // "a", "b" and "c"
std::string number_text(double value);                         // shortest text that reads back exactly

/// The key of a side of the domain: "sides.x_min" for axis 0 and end 0.
std::string side_key(int axis, int end);

/// Takes the first key off a path: of "grid.cells" it gives "grid" and leaves "cells".
inline std::string_view first_part(std::string_view& path) {
    const std::string_view part = path.substr(0, path.find('.'));
    path.remove_prefix(std::min(part.size() + 1, path.size()));
    return part;
}

}  // namespace weir::scene
