#include "scene/formula.hpp"

#include "scene/names.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <muParser.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <stdexcept>

namespace weir::scene {

namespace {

struct Function {
    const char* name;
    real (*value)(real);
};

struct Function2 {
    const char* name;
    real (*value)(real, real);
};

constexpr std::array<Function, 14> functions{{
    {"abs", [](real a) { return std::abs(a); }},
    {"sqrt", [](real a) { return std::sqrt(a); }},
    {"exp", [](real a) { return std::exp(a); }},
    {"log", [](real a) { return std::log(a); }},
    {"sin", [](real a) { return std::sin(a); }},
    {"cos", [](real a) { return std::cos(a); }},
    {"tan", [](real a) { return std::tan(a); }},
    {"atan", [](real a) { return std::atan(a); }},
    {"sinh", [](real a) { return std::sinh(a); }},
    {"cosh", [](real a) { return std::cosh(a); }},
    {"tanh", [](real a) { return std::tanh(a); }},
    {"sech", [](real a) { return 1 / std::cosh(a); }},
    {"floor", [](real a) { return std::floor(a); }},
    {"step", [](real a) { return a < 0 ? 0.0 : 1.0; }},
}};

constexpr std::array<Function2, 5> functions_of_two{{
    {"min", [](real a, real b) { return std::min(a, b); }},
    {"max", [](real a, real b) { return std::max(a, b); }},
    {"hypot", [](real a, real b) { return std::sqrt(a * a + b * b); }},
    {"atan2", [](real a, real b) { return std::atan2(a, b); }},
    {"mod", [](real a, real b) { return a - b * std::floor(a / b); }},
}};

/// Rewords muParser's messages, which name its own callbacks and operators, in terms of the scene's text.
std::string told(const mu::Parser::exception_type& e) {
    const std::string& token = e.GetToken();
    switch (e.GetCode()) {
        case mu::ecUNASSIGNABLE_TOKEN:
            return fmt::format("unknown name \"{}\" in the formula", token);
        case mu::ecUNEXPECTED_EOF:
            return "the formula ends where a value is expected";
        case mu::ecMISSING_PARENS:
            return "a closing bracket is missing";
        case mu::ecTOO_FEW_PARAMS:
        case mu::ecTOO_MANY_PARAMS:
            return fmt::format("\"{}\" requires another number of arguments", token);
        default:
            return fmt::format("\"{}\" is not expected here", token);
    }
}

/// Rejects muParser's assignment: a formula returns a value and changes none.
void refuse_assignment(std::string_view text) {
    const std::string_view pairs = "=<>!";
    for (std::size_t i = 0; i < text.size(); ++i)
        if (text[i] == '=') {
            const bool compares = i > 0 && pairs.find(text[i - 1]) != std::string_view::npos;
            if (!compares && (i + 1 >= text.size() || text[i + 1] != '='))
                throw BadFormula(static_cast<int>(i), 1, "\"=\" is not expected here");
        }
}

}  // namespace

struct Formula::Compiled {
    std::mutex one_at_a_time;  // muParser reads variables at their bound addresses
    std::vector<real> values;
    mu::Parser parser;
};

Formula::Formula(std::string_view text, const std::vector<std::string>& variables) : compiled_(std::make_shared<Compiled>()) {
    refuse_assignment(text);
    mu::Parser& parser = compiled_->parser;
    compiled_->values.resize(variables.size());
    try {
        parser.ClearFun();
        parser.ClearConst();
        parser.DefineConst("pi", pi);
        for (const Function& f : functions) parser.DefineFun(f.name, f.value);
        for (const Function2& f : functions_of_two) parser.DefineFun(f.name, f.value);
        for (std::size_t v = 0; v < variables.size(); ++v) parser.DefineVar(variables[v], &compiled_->values[v]);
        parser.SetExpr(std::string(text));
        parser.Eval();
        if (parser.GetNumResults() != 1) throw BadFormula(0, static_cast<int>(text.size()), "one value is expected");
    } catch (const mu::Parser::exception_type& e) {
        const int end = static_cast<int>(text.size()), at = std::clamp(static_cast<int>(e.GetPos()), 0, end);
        throw BadFormula(at, std::clamp(static_cast<int>(e.GetToken().size()), 1, std::max(1, end - at)), told(e));
    }
}

real Formula::operator()(std::span<const real> values) const {
    std::vector<real>& variables = compiled_->values;
    if (values.size() < variables.size()) throw std::logic_error("a formula is evaluated with fewer values than it has variables");
    const std::lock_guard<std::mutex> lock(compiled_->one_at_a_time);
    std::copy_n(values.begin(), variables.size(), variables.begin());
    return compiled_->parser.Eval();
}

const std::string& Formula::words() {
    static const std::string list = [] {
        std::string all = "numbers, pi, + - * / ^ ( ), < <= > >= == != && || ?:";
        for (const Function& f : functions) all += std::string(", ") + f.name + "()";
        for (const Function2& f : functions_of_two) all += std::string(", ") + f.name + "(,)";
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
        // the text begins after its quotation mark; in other notations (""" or an escape) the whole value is underlined
        if (p.place.column > 0 && p.place.override_number < 0 && text.find_first_of("\n\t\\\"") == std::string::npos)
            p.place.column += 1 + bad.at, p.width = bad.width;
        scene.refuse({p});
    }
}

Variant formula_variant(const char* unit) {
    return {"formula",
            "A formula of x and y, and of z in 3D: numbers, pi, + - * / ^ ( ), functions such as sin, exp, max.",
            {{.name = "value", .type = Type::text, .doc = "The formula.", .unit = unit, .required = true}}};
}

template <int D>
std::function<real(const Vec<D>&)> formula_of_place(const Scene& scene, std::string_view path) {
    std::vector<std::string> axes{"x", "y", "z"};
    axes.resize(D);
    return [f = formula_at(scene, path, axes)](const Vec<D>& x) { return f(std::span<const real>(&x[0], D)); };
}
template std::function<real(const Vec<2>&)> formula_of_place<2>(const Scene&, std::string_view);
template std::function<real(const Vec<3>&)> formula_of_place<3>(const Scene&, std::string_view);

}  // namespace weir::scene
