// Writes a gnuplot program with its data inside and runs it. Text that comes from files stands in single quotes, in which gnuplot replaces
// nothing; the figure comes from its standard output, because a name after `set output` may be a command.
#include "validation/report/svg.hpp"

#include "core/error.hpp"
#include "core/programs.hpp"
#include "output/atomic_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <system_error>

namespace weir::validation {
namespace {

// Okabe & Ito 2008: told apart by colour-blind readers too.
constexpr const char* colours[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000", "#999999"};
constexpr int marks[] = {7, 4, 8};                    // disk, square, triangle: for the second and third round through the colours
constexpr int panel_width = 560, panel_height = 420;  // pixels

/// One line without control characters.
std::string plain(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }, ' ');
    return text;
}

/// A text of a gnuplot program. Within double quotes gnuplot runs what stands between back quotes; within single ones nothing is replaced,
/// and a single quote stands as two.
std::string quoted(const std::string& text) {
    std::string all = "'";
    for (const char c : plain(text)) all += c == '\'' ? "''" : std::string(1, c);
    return all + "'";
}

/// A text of a data block, which knows double quotes only, has no sign for one within, and runs nothing.
std::string quoted_datum(std::string text) {
    std::replace(text.begin(), text.end(), '"', '\'');
    std::replace(text.begin(), text.end(), '\\', '/');
    return '"' + plain(text) + '"';
}

/// A point can be drawn: finite, and positive where an axis is logarithmic.
bool drawable(const Panel& p, real x, real y) { return std::isfinite(x) && std::isfinite(y) && (!p.x.log || x > 0) && (!p.y.log || y > 0); }

std::size_t drawable_points(const Panel& p, const Curve& c) {
    std::size_t n = 0;
    for (std::size_t i = 0; i < c.size(); ++i) n += drawable(p, c.x[i], c.y[i]);
    return n;
}

/// A curve that has more points than the panel has pixels, thinned: of each stretch the lowest and the highest point, so that no peak is
/// lost. A minute of steps would else make a file of megabytes.
Curve thinned(const Curve& c) {
    constexpr std::size_t stretches = panel_width;
    if (c.size() <= 4 * stretches || c.points || !c.names.empty()) return c;
    Curve thin = c;
    thin.x.clear(), thin.y.clear();
    const auto keep = [&](std::size_t i) { thin.x.push_back(c.x[i]), thin.y.push_back(c.y[i]); };
    for (std::size_t s = 0; s < stretches; ++s) {
        const auto first = c.y.begin() + static_cast<std::ptrdiff_t>(c.size() * s / stretches);
        const auto last = c.y.begin() + static_cast<std::ptrdiff_t>(c.size() * (s + 1) / stretches);
        const auto [low, high] = std::minmax_element(first, last);
        keep(static_cast<std::size_t>(std::min(low, high) - c.y.begin()));
        if (low != high) keep(static_cast<std::size_t>(std::max(low, high) - c.y.begin()));
    }
    keep(c.size() - 1);
    return thin;
}

/// Ticks and scale of one axis that spans low..high.
std::string axis(const char* name, bool log, real low, real high) {
    const std::string plain = fmt::format("set {0}tics auto; set format {0} '%g'\n", name);
    if (!log) {
        if (!(low == high)) return plain;
        const real half = std::max(1e-12, std::abs(low));  // a flat line in mid-panel, not on its edge
        return plain + fmt::format("set {}range [{}:{}]\n", name, low - half, high + half);
    }
    if (low == high) return plain + fmt::format("set logscale {0}\nset {0}range [{1}:{2}]\n", name, low / 10, low * 10);
    std::string s = plain + fmt::format("set logscale {0}\nset {0}range [{1}:{2}]\n", name, low / 1.3, high * 1.3);
    if (high / low > 100) return s + fmt::format("set format {} '10^{{%T}}'\n", name);
    // Less than two decades: ticks at some digits of each, or the axis would have one label or none.
    const std::vector<real> digits = high / low < 8 ? std::vector<real>{1, 1.5, 2, 3, 4, 5, 7} : std::vector<real>{1, 2, 5};
    s += fmt::format("set {}tics (", name);
    const char* comma = "";
    for (real decade = std::pow(10.0, std::floor(std::log10(low)) - 1); decade <= high * 10; decade *= 10)
        for (const real digit : digits) {
            if (digit * decade < low / 1.3 || digit * decade > high * 1.3) continue;
            s += fmt::format("{0}'{1:.4g}' {1:.4g}", comma, digit * decade), comma = ", ";
        }
    return s + ")\n";
}

std::string axes_of(const Panel& p) {
    real low[2] = {infinity, infinity}, high[2] = {-infinity, -infinity};
    for (const Curve& c : p.curves)
        for (std::size_t i = 0; i < c.size(); ++i) {
            if (!drawable(p, c.x[i], c.y[i])) continue;
            const real at[2] = {c.x[i], c.y[i]};
            for (int a : {0, 1}) low[a] = std::min(low[a], at[a]), high[a] = std::max(high[a], at[a]);
        }
    return "set autoscale; unset logscale\n" + axis("x", p.x.log, low[0], high[0]) + axis("y", p.y.log, low[1], high[1]);
}

std::string style_of(const Curve& c, std::size_t number) {
    const char* colour = colours[number % std::size(colours)];
    if (c.points) return fmt::format("with points pt {} ps 0.8 lc rgb '{}'", 4 + 2 * (number % 6), colour);
    if (c.dashed) return "with lines dt 2 lw 1.5 lc rgb '#777777'";
    if (c.size() <= 12)
        return fmt::format("with linespoints pt {} ps 0.7 lw {} lc rgb '{}'", marks[number / std::size(colours) % std::size(marks)],
                           number < std::size(colours) ? 2 : 1, colour);
    return fmt::format("with lines lw 2 lc rgb '{}'", colour);
}

std::string panel_program(const Panel& p, std::size_t number) {
    std::string data, plots;
    std::size_t drawn = 0;
    for (const Curve& whole : p.curves) {
        if (drawable_points(p, whole) == 0) continue;
        const Curve c = thinned(whole);
        const std::string block = fmt::format("$p{}c{}", number, drawn);
        data += block + " << EOD\n";
        for (std::size_t i = 0; i < c.size(); ++i)
            if (drawable(p, c.x[i], c.y[i]))
                data += fmt::format("{:.9g} {:.9g} {}\n", c.x[i], c.y[i], quoted_datum(i < c.names.size() ? c.names[i] : ""));
        data += "EOD\n";
        plots += fmt::format("{}{} using 1:2 {} title {} noenhanced", drawn ? ", \\\n     " : "plot ", block, style_of(c, drawn),
                             quoted(c.label));
        if (!c.names.empty())
            plots += fmt::format(", \\\n     {} using 1:2:3 with labels left offset 0.6,0.5 font ',10' notitle noenhanced", block);
        ++drawn;
    }
    if (drawn == 0) return "set multiplot next\n";
    std::string s = data + axes_of(p);
    s += fmt::format("set title {} noenhanced\nset xlabel {} noenhanced offset 0,0.5\nset ylabel {} noenhanced\n", quoted(p.title),
                     quoted(p.x.label), quoted(p.y.label));
    s += "set key outside below maxcols 3 samplen 2 font ',11'\n";  // never over the data
    return s + plots + "\n";
}

}  // namespace

std::string gnuplot_program(const std::string& title, const std::vector<Panel>& panels) {
    const int columns = panels.size() > 1 ? 2 : 1;
    const int rows = (static_cast<int>(panels.size()) + columns - 1) / columns;
    std::string s =
        fmt::format("set terminal svg size {},{} font 'sans,13' background '#ffffff'\n", columns * panel_width, rows * panel_height + 30);
    s += "set grid lc rgb '#dddddd'; set border lw 1; set lmargin 11; set rmargin 3\n";
    s += fmt::format("set multiplot layout {},{} title {} noenhanced font ',16'\n", rows, columns, quoted(title));
    for (std::size_t i = 0; i < panels.size(); ++i) s += panel_program(panels[i], i);
    return s + "unset multiplot\n";
}

void draw(const std::string& title, const std::vector<Panel>& panels, const std::filesystem::path& svg) {
    std::error_code failed;
    std::filesystem::create_directories(svg.parent_path(), failed);
    if (failed) throw OutputError("cannot make the folder " + svg.parent_path().string() + ": " + failed.message());
    const auto beside = [&](const char* ending) { return std::filesystem::absolute(svg).replace_extension(ending); };
    const auto program = beside(".gnuplot"), drawn = beside(".svg.part");
    output::write_file(program, gnuplot_program(title, panels));
    const int code = run_program({"gnuplot", program.string()}, {.out = drawn});
    if (code != 0) {
        std::filesystem::remove(drawn, failed);
        throw OutputError(code == 127 ? "cannot draw " + svg.string() +
                                            ": gnuplot is not on the PATH (Debian: gnuplot-nox); its program is " + program.string()
                                      : "gnuplot could not draw " + svg.string() + "; its program is " + program.string());
    }
    std::filesystem::rename(drawn, svg, failed);
    if (failed) throw OutputError("cannot write " + svg.string() + ": " + failed.message());
    std::filesystem::remove(program, failed);
}

}  // namespace weir::validation
