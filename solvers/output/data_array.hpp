// Description of a data array of a file: its elements are fetched while it is written, and in parallel each rank has a part of its tuples.
#pragma once
#include "core/types.hpp"
#include "parallel/communicator.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace weir::output {

/// Minimum and maximum as computed by VTK: for an empty array, the largest and the lowest double. Of equal values (0 and -0) the first one,
/// where VTK takes that of whichever thread was first.
struct Extremes {
    static constexpr double least_of_none = 1.0e+299, most_of_none = -1.0e+299;
    double least = least_of_none, most = most_of_none;
    void meet(double value) {
        if (value < least) least = value;
        if (most < value) most = value;
    }
    void meet(const Extremes& next) {
        if (next.least < least) least = next.least;
        if (most < next.most) most = next.most;
    }
};

/// Elements of one type, tuple by tuple.
class Numbers {
public:
    virtual ~Numbers() = default;
    /// Copies the elements [first, first + count); component c of tuple i is element c + components i.
    virtual void copy(std::size_t first, std::size_t count, std::byte* to) const = 0;
    /// Extremes of these tuples; for several components the squares of the magnitudes.
    virtual Extremes extremes(std::size_t begin, std::size_t end) const = 0;
};

/// The partition of the tuples: rank r has [begins[r], begins[r + 1]).
struct Parts {
    std::vector<std::size_t> begins;

    std::size_t begin(int rank) const { return begins[static_cast<std::size_t>(rank)]; }
    std::size_t end(int rank) const { return begins[static_cast<std::size_t>(rank) + 1]; }
    std::size_t all() const { return begins.back(); }
    bool all_on_first() const { return begins[1] == all(); }
    /// All on rank 0.
    static Parts of_first(std::size_t all) {
        Parts parts{std::vector<std::size_t>(static_cast<std::size_t>(communicator().ranks()) + 1, all)};
        parts.begins[0] = 0;
        return parts;
    }
};

struct DataArray {
    std::string name;
    const char* type;  // VTK's name
    int components;
    std::size_t bytes_of_number;
    Parts tuples;
    std::shared_ptr<const Numbers> numbers;
    bool tells_extremes = true;
};

namespace detail {

template <class T>
constexpr const char* vtk_type() {
    if constexpr (std::is_same_v<T, float>) return "Float32";
    if constexpr (std::is_same_v<T, double>) return "Float64";
    if constexpr (std::is_same_v<T, std::int64_t>) return "Int64";
    if constexpr (std::is_same_v<T, std::uint8_t>) return "UInt8";
}

template <class T, class Value>
class NumbersOf final : public Numbers {
public:
    NumbersOf(int components, Value value) : components_(components), value_(std::move(value)) {}
    void copy(std::size_t first, std::size_t count, std::byte* to) const override {
        auto* out = reinterpret_cast<T*>(to);
        const auto n = static_cast<std::size_t>(components_);
        std::size_t i = first / n;
        for (int c = static_cast<int>(first % n); count > 0; --count) {
            *out++ = static_cast<T>(value_(i, c));
            if (++c == components_) c = 0, ++i;
        }
    }
    Extremes extremes(std::size_t begin, std::size_t end) const override {
        Extremes found;
        for (std::size_t i = begin; i < end; ++i) {
            if (components_ == 1) {
                found.meet(static_cast<double>(static_cast<T>(value_(i, 0))));
                continue;
            }
            double squares = 0;
            for (int c = 0; c < components_; ++c) {
                const auto one = static_cast<double>(static_cast<T>(value_(i, c)));
                squares += one * one;
            }
            found.meet(squares);
        }
        return found;
    }

private:
    int components_;
    Value value_;
};

}  // namespace detail

/// Component c of tuple i is value(i, c), evaluated on the rank that has it.
template <class T, class Value>
DataArray data_array(std::string name, int components, Parts tuples, Value value) {
    return {std::move(name), detail::vtk_type<T>(), components,
            sizeof(T),       std::move(tuples),     std::make_shared<detail::NumbersOf<T, Value>>(components, std::move(value))};
}

}  // namespace weir::output
