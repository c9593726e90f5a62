#include "scene/formula.hpp"

#include "scene/names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>

namespace weir::scene {

namespace {

enum Code { constant, variable, add, subtract, multiply, divide, power, negate, function };

struct Function {
    const char* name;
    int arguments;
    real (*value)(real, real);
};

constexpr std::array<Function, 19> functions{{
    {"abs", 1, [](real a, real) { return std::abs(a); }},
    {"sqrt", 1, [](real a, real) { return std::sqrt(a); }},
    {"exp", 1, [](real a, real) { return std::exp(a); }},
    {"log", 1, [](real a, real) { return std::log(a); }},
    {"sin", 1, [](real a, real) { return std::sin(a); }},
    {"cos", 1, [](real a, real) { return std::cos(a); }},
    {"tan", 1, [](real a, real) { return std::tan(a); }},
    {"atan", 1, [](real a, real) { return std::atan(a); }},
    {"sinh", 1, [](real a, real) { return std::sinh(a); }},
    {"cosh", 1, [](real a, real) { return std::cosh(a); }},
    {"tanh", 1, [](real a, real) { return std::tanh(a); }},
    {"sech", 1, [](real a, real) { return 1 / std::cosh(a); }},
    {"floor", 1, [](real a, real) { return std::floor(a); }},
    {"step", 1, [](real a, real) { return a < 0 ? 0.0 : 1.0; }},
    {"min", 2, [](real a, real b) { return std::min(a, b); }},
    {"max", 2, [](real a, real b) { return std::max(a, b); }},
    {"hypot", 2, [](real a, real b) { return std::sqrt(a * a + b * b); }},
    {"atan2", 2, [](real a, real b) { return std::atan2(a, b); }},
    {"mod", 2, [](real a, real b) { return a - b * std::floor(a / b); }},
}};

constexpr int most_depth = 64;  // of brackets: more is a mistake, and would overflow the stack

}  // namespace

/// Recursive descent: sum = product {+- product}, product = signed {*/ signed}, signed = [-+] power, power = atom [^ signed].
class FormulaParser {
public:
    FormulaParser(std::string_view text, const std::vector<std::string>& variables, Formula& to)
        : text_(text), variables_(variables), to_(to) {}
    void parse() {
        sum();
        skip();
        if (at_ < text_.size()) fail(at_, 1, fmt::format("\"{}\" is not expected here", text_[at_]));
    }

private:
    [[noreturn]] void fail(std::size_t at, std::size_t width, const std::string& what) const {
        throw BadFormula(static_cast<int>(at), static_cast<int>(width), what);
    }
    void skip() {
        while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\n' || text_[at_] == '\t')) ++at_;
    }
    bool take(char c) {
        skip();
        if (at_ >= text_.size() || text_[at_] != c) return false;
        ++at_;
        return true;
    }
    void emit(int code, real value = 0, int number = 0) { to_.code_.push_back({code, value, number}); }

    void sum() {
        if (++depth_ > most_depth) fail(at_, 1, "the formula is nested too deeply");
        product();
        for (;;) {
            if (take('+'))
                product(), emit(add);
            else if (take('-'))
                product(), emit(subtract);
            else
                break;
        }
        --depth_;
    }
    void product() {
        with_sign();
        for (;;) {
            if (take('*'))
                with_sign(), emit(multiply);
            else if (take('/'))
                with_sign(), emit(divide);
            else
                return;
        }
    }
    void with_sign() {
        bool minus = false;
        for (;;) {
            if (take('-'))
                minus = !minus;
            else if (!take('+'))
                break;
        }
        atom();
        if (take('^')) {
            if (++depth_ > most_depth) fail(at_, 1, "the formula is nested too deeply");
            with_sign(), emit(power);
            --depth_;
        }
        if (minus) emit(negate);
    }
    void atom() {
        skip();
        if (at_ >= text_.size()) fail(at_, 1, "the formula ends where a value is expected");
        const char c = text_[at_];
        if (take('(')) {
            sum();
            if (!take(')')) fail(at_, 1, "a closing bracket is missing");
        } else if (std::isdigit(static_cast<unsigned char>(c)) || c == '.') {
            number();
        } else if (std::isalpha(static_cast<unsigned char>(c))) {
            word();
        } else {
            fail(at_, 1, fmt::format("\"{}\" stands where a value is expected", c));
        }
    }
    void number() {
        real value = 0;
        const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
        if (error != std::errc()) fail(at_, 1, "this is no number");
        at_ = static_cast<std::size_t>(end - text_.data());
        emit(constant, value);
    }
    void word() {
        const std::size_t begin = at_;
        while (at_ < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[at_])) || text_[at_] == '_')) ++at_;
        const std::string_view name = text_.substr(begin, at_ - begin);
        if (name == "pi") return emit(constant, pi);
        for (std::size_t v = 0; v < variables_.size(); ++v)
            if (name == variables_[v]) return emit(variable, 0, static_cast<int>(v));
        for (std::size_t f = 0; f < functions.size(); ++f)
            if (name == functions[f].name) return call(f, begin);
        fail(begin, name.size(), fmt::format("the formula knows no \"{}\"", name));
    }
    void call(std::size_t f, std::size_t begin) {
        const std::string name = functions[f].name;
        if (!take('(')) fail(begin, name.size(), fmt::format("\"{}\" wants its argument in brackets", name));
        sum();
        for (int a = 1; a < functions[f].arguments; ++a) {
            if (!take(',')) fail(at_, 1, fmt::format("\"{}\" wants {} arguments", name, functions[f].arguments));
            sum();
        }
        if (!take(')')) fail(at_, 1, fmt::format("a closing bracket of \"{}\" is missing", name));
        emit(function, 0, static_cast<int>(f));
    }

    std::string_view text_;
    const std::vector<std::string>& variables_;
    Formula& to_;
    std::size_t at_ = 0;
    int depth_ = 0;
};

Formula::Formula(std::string_view text, const std::vector<std::string>& variables) { FormulaParser(text, variables, *this).parse(); }

real Formula::operator()(std::span<const real> values) const {
    std::array<real, 4 * most_depth + 8> stack;  // each bracket keeps at most three values waiting: of a sum, a product, a power
    std::size_t n = 0;
    for (const Operation& o : code_) {
        const auto second = [&] { return stack[--n]; };
        switch (o.code) {
            case constant:
                stack[n++] = o.value;
                break;
            case variable:
                stack[n++] = values[static_cast<std::size_t>(o.variable)];
                break;
            case negate:
                stack[n - 1] = -stack[n - 1];
                break;
            case function: {
                const Function& f = functions[static_cast<std::size_t>(o.variable)];
                const real b = f.arguments == 2 ? second() : 0;
                stack[n - 1] = f.value(stack[n - 1], b);
                break;
            }
            default: {
                const real b = second();
                real& a = stack[n - 1];
                // squares by multiplication: x^2 is what bowls and bumps are made of, and pow is slower and no better
                a = o.code == add        ? a + b
                    : o.code == subtract ? a - b
                    : o.code == multiply ? a * b
                    : o.code == divide   ? a / b
                    : b == 2             ? a * a
                                         : std::pow(a, b);
            }
        }
    }
    return n == 1 ? stack[0] : std::nan("");
}

const std::string& Formula::words() {
    static const std::string list = [] {
        std::string all = "numbers, pi, + - * / ^ ( )";
        for (const Function& f : functions) all += std::string(", ") + f.name + (f.arguments == 2 ? "(,)" : "()");
        return all;
    }();
    return list;
}

Formula formula_at(const Scene& scene, std::string_view path, const std::vector<std::string>& variables) {
    const std::string& text = scene.text(path);
    try {
        return Formula(text, variables);
    } catch (const BadFormula& bad) {
        Problem p = scene.problem(
            path, fmt::format("{}: {}", path, bad.what()),
            fmt::format("{} of {}; {}", variables.size() == 1 ? "a formula" : "formulas", fmt::join(variables, ", "), Formula::words()));
        // the text begins behind its quotation mark; where it is written otherwise (""" or an escape), the whole value is underlined
        if (p.place.column > 0 && p.place.override_number < 0 && text.find_first_of("\n\t\\\"") == std::string::npos)
            p.place.column += 1 + bad.at, p.width = bad.width;
        scene.refuse({p});
    }
}

}  // namespace weir::scene
