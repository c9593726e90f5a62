#include "metamorphic/units.hpp"

#include <cctype>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>

namespace weir::metamorphic {
namespace {

const std::map<std::string, Dimension, std::less<>>& base_units() {
    static const std::map<std::string, Dimension, std::less<>> list = {
        {"1", {}},         {"K", {}},         {"rad", {}},       {"mol", {}},       {"m", {1, 0, 0}},   {"s", {0, 1, 0}},
        {"kg", {0, 0, 1}}, {"N", {1, -2, 1}}, {"J", {2, -2, 1}}, {"W", {2, -3, 1}}, {"Pa", {-1, -2, 1}}};
    return list;
}

/// Reads factors "m^2", "(kg s)" and a quotient of them.
class Parser {
public:
    explicit Parser(std::string_view text) : text_(text) {}

    Dimension product() {
        Dimension d;
        double sign = 1;
        while (at_ < text_.size() && text_[at_] != ')') {
            if (text_[at_] == ' ') {
                ++at_;
            } else if (text_[at_] == '/') {
                ++at_, sign = -1;
            } else {
                add(d, factor(), sign);
                sign = 1;
            }
        }
        return d;
    }

private:
    static void add(Dimension& d, const Dimension& f, double power) {
        d.length += power * f.length, d.time += power * f.time, d.mass += power * f.mass;
    }

    Dimension factor() {
        Dimension d;
        if (text_[at_] == '(') {
            ++at_, d = product(), ++at_;
        } else {
            const std::size_t first = at_;
            while (at_ < text_.size() && std::isalnum(static_cast<unsigned char>(text_[at_]))) ++at_;
            const auto unit = base_units().find(text_.substr(first, at_ - first));
            if (at_ == first || unit == base_units().end()) throw std::logic_error("unknown unit \"" + std::string(text_) + "\"");
            d = unit->second;
        }
        if (at_ < text_.size() && text_[at_] == '^') {
            ++at_;
            const double power = exponent();
            d.length *= power, d.time *= power, d.mass *= power;
        }
        return d;
    }

    double integer() {
        double n = 0;
        while (at_ < text_.size() && std::isdigit(static_cast<unsigned char>(text_[at_]))) n = 10 * n + (text_[at_++] - '0');
        return n;
    }

    double exponent() {
        if (text_[at_] != '(') return integer();
        ++at_;
        double e = integer();
        if (text_[at_] == '/') ++at_, e /= integer();
        ++at_;
        return e;
    }

    std::string_view text_;
    std::size_t at_ = 0;
};

}  // namespace

Dimension dimension_of(std::string_view unit) { return Parser(unit).product(); }

double UnitScale::of(const Dimension& d) const { return std::pow(length, d.length) * std::pow(time, d.time) * std::pow(mass, d.mass); }

}  // namespace weir::metamorphic
