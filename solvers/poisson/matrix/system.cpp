#include "poisson/matrix/system.hpp"

#include "core/scratch.hpp"
#include "poisson/faces.hpp"

#include <algorithm>
#include <numeric>

namespace weir::poisson {

namespace {

real off_diagonal(const Matrix& A, const Vector& x, std::size_t i) {
    real sum = 0;
    for (int k = A.start[i]; k < A.start[i + 1]; ++k) {
        const auto entry = static_cast<std::size_t>(k);
        sum += A.weight[entry] * x[static_cast<std::size_t>(A.column[entry])];
    }
    return sum;
}

template <class T>
std::size_t bytes_of(const std::vector<T>& v) {
    return v.capacity() * sizeof(T);
}

}  // namespace

std::size_t Matrix::bytes() const { return bytes_of(start) + bytes_of(column) + bytes_of(weight) + bytes_of(diagonal); }

void residual(const Matrix& A, const Vector& x, const Vector& b, Vector& r) {
    for_each_block(x.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) r[i] = b[i] - (A.diagonal[i] * x[i] - off_diagonal(A, x, i));
    });
}

void multiply(const Matrix& A, const Vector& x, Vector& y) {
    for_each_block(x.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) y[i] = A.diagonal[i] * x[i] - off_diagonal(A, x, i);
    });
}

real dot(const Vector& a, const Vector& b) {
    return sum_of_blocks(a.size(), [&](std::size_t begin, std::size_t end) {
        real sum = 0;
        for (std::size_t i = begin; i < end; ++i) sum += a[i] * b[i];
        return sum;
    });
}

void Components::remove_means(Vector& x) const {
    if (closed == 0) return;
    refill_scratch<real>(sum_, static_cast<std::size_t>(closed), 0);
    refill_scratch<real>(count_, static_cast<std::size_t>(closed), 0);
    for (std::size_t i = 0; i < x.size(); ++i)
        if (of[i] >= 0) sum_[static_cast<std::size_t>(of[i])] += x[i], count_[static_cast<std::size_t>(of[i])] += 1;
    for (std::size_t c = 0; c < sum_.size(); ++c) sum_[c] /= count_[c];
    for (std::size_t i = 0; i < x.size(); ++i)
        if (of[i] >= 0) x[i] -= sum_[static_cast<std::size_t>(of[i])];
}

std::size_t Components::bytes() const { return bytes_of(of) + bytes_of(sum_) + bytes_of(count_); }

int ComponentFinder::root(int i) {
    const auto parent = [&](int j) -> int& { return parent_[static_cast<std::size_t>(j)]; };
    while (parent(i) != i) i = parent(i) = parent(parent(i));
    return i;
}

void ComponentFinder::find(const Matrix& A, Components& components) {
    const auto n = static_cast<std::size_t>(A.size());
    parent_.resize(n);
    std::iota(parent_.begin(), parent_.end(), 0);
    open_.assign(n, 0);
    for (std::size_t i = 0; i < n; ++i) {
        real weights = 0;
        for (int k = A.start[i]; k < A.start[i + 1]; ++k) {
            const auto entry = static_cast<std::size_t>(k);
            weights += A.weight[entry];
            if (A.column[entry] >= static_cast<int>(i) || !(A.weight[entry] > 0)) continue;
            const int a = root(A.column[entry]), b = root(static_cast<int>(i));
            parent_[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
        }
        open_[i] = A.diagonal[i] > weights;
    }
    for (std::size_t i = 0; i < n; ++i)
        if (open_[i]) open_[static_cast<std::size_t>(root(static_cast<int>(i)))] = 1;
    components.closed = 0;
    number_.assign(n, -1);
    for (std::size_t i = 0; i < n; ++i)
        if (parent_[i] == static_cast<int>(i) && !open_[i]) number_[i] = components.closed++;
    components.of.clear();
    if (components.closed == 0) return;
    for (std::size_t i = 0; i < n; ++i) components.of.push_back(number_[static_cast<std::size_t>(root(static_cast<int>(i)))]);
}

std::size_t ComponentFinder::bytes() const { return bytes_of(parent_) + bytes_of(number_) + bytes_of(open_); }

namespace {

/// Parity, and a bit for each odd periodic axis whose last layer contains the cell: neighbours across that boundary would have equal
/// parity.
template <int D>
std::uint8_t colour_of(const Operator<D>& op, const Index<D>& I) {
    int parity = 0, last = 0;
    for (int a = 0; a < D; ++a) {
        const int n = op.cells.extent()[a];
        parity += I[a];
        if (op.periodic[static_cast<std::size_t>(a)] && n % 2 == 1 && I[a] == n - 1) last |= 2 << a;
    }
    return static_cast<std::uint8_t>(last | (parity & 1));
}

template <int D, class F>
void for_each_in_order(const Index<D>& extent, F&& f) {
    Index<D> I{};
    for (std::size_t at = 0, count = product(extent); at < count; ++at) {
        f(I, at);
        for (int a = 0; a < D && ++I[a] == extent[a]; ++a)
            if (a + 1 < D) I[a] = 0;
    }
}

template <std::size_t N>
void insert_sorted(std::array<std::pair<int, real>, N>& entry, std::size_t count, const std::pair<int, real>& value) {
    for (; count > 0 && value < entry[count - 1]; --count) entry[count] = entry[count - 1];
    entry[count] = value;
}

/// Appends the row of cell I: weights to fluid neighbours by ascending number, and the diagonal with all open faces. The diagonal is the
/// sum of the sorted weights, so it exceeds them exactly when a face or `zero` leads to p = 0.
template <int D>
void append_row(Matrix& A, const Operator<D>& op, const std::vector<int>& number, const Index<D>& I, real zero) {
    std::array<std::pair<int, real>, 2 * D> entry;
    std::size_t count = 0;
    real to_zero = zero;
    for (int a = 0; a < D; ++a)
        for (int side = 0; side < 2; ++side) {
            const real w = face_weight(op, I, a, side);
            if (!(w > 0)) continue;
            const auto [N, outside] = neighbour(op, I, a, side);
            if (outside || op.cells(N) != Cell::fluid)
                to_zero += w;
            else
                insert_sorted(entry, count++, {number[op.cells.linear(N)], w});
        }
    real diagonal = 0;
    for (std::size_t k = 0; k < count; ++k) {
        diagonal += entry[k].second;
        A.column.push_back(entry[k].first);
        A.weight.push_back(entry[k].second);
    }
    A.diagonal.push_back(diagonal + to_zero);
    A.start.push_back(static_cast<int>(A.column.size()));
}

}  // namespace

template <int D>
void System<D>::build(const Operator<D>& op, const Grid<real, D>* zero) {
    const auto& extent = op.cells.extent();
    std::vector<int> number(op.cells.size(), -1);
    cell.clear();
    colour.clear();
    A.start.assign(1, 0);
    A.column.clear();
    A.weight.clear();
    A.diagonal.clear();
    for (std::size_t i = 0; i < op.cells.size(); ++i)
        if (op.cells[i] == Cell::fluid) {
            number[i] = static_cast<int>(cell.size());
            cell.push_back(static_cast<int>(i));
        }
    for_each_in_order<D>(extent, [&](const Index<D>& I, std::size_t at) {
        if (number[at] < 0) return;
        colour.push_back(colour_of(op, I));
        append_row(A, op, number, I, zero ? (*zero)[at] : 0);
    });
    ComponentFinder().find(A, components);
}

template <int D>
std::size_t System<D>::bytes() const {
    return A.bytes() + bytes_of(cell) + bytes_of(colour) + components.bytes();
}

template struct System<2>;
template struct System<3>;

}  // namespace weir::poisson
