#include "poisson/matrix/added_columns.hpp"

namespace weir::poisson {

template <int D>
void AddedColumns<D>::begin(const LowRank& more, const Layout<D>& at, Grid<real, D>& b) {
    more_ = &more, b_ = &b;
    places_.clear(), given_.clear();
    for (const LowRank::Entry& entry : more.entries) {
        const int cell = static_cast<int>(entry.cell), row = cell / at.n[0], i = cell % at.n[0];
        const int parity = at.parity(row / at.rows_in_plane(), row % at.rows_in_plane());
        places_.push_back({static_cast<std::size_t>((i ^ parity) & 1), at.offset(row) + i / 2});
        given_.push_back(b[entry.cell]);
    }
    for (auto* rows : {&x_, &u_, &p_}) rows->assign(more.blocks.size(), Row{});
}

template <int D>
void AddedColumns<D>::end() {
    for (std::size_t i = 0; i < given_.size(); ++i) (*b_)[more_->entries[i].cell] = given_[i];
    more_ = nullptr;
}

template <int D>
void AddedColumns<D>::see_zero() {
    std::fill(x_.begin(), x_.end(), Row{});
}

template <int D>
void AddedColumns<D>::see(const Grid<real, D>& p) {
    see_zero();
    for (std::size_t k = 0; k < x_.size(); ++k)
        for (std::size_t i = more_->blocks[k].begin; i < more_->blocks[k].end; ++i)
            for (std::size_t l = 0; l < LowRank::columns; ++l) x_[k][l] += more_->entries[i].u[l] * p[more_->entries[i].cell];
}

template <int D>
template <class T>
void AddedColumns<D>::product(const Coloured<T>& v, std::vector<Row>& sums) const {
    for (std::size_t k = 0; k < sums.size(); ++k) {
        Row sum{};
        for (std::size_t i = more_->blocks[k].begin; i < more_->blocks[k].end; ++i) {
            const real value = v[places_[i].colour][places_[i].entry];
            for (std::size_t l = 0; l < LowRank::columns; ++l) sum[l] += more_->entries[i].u[l] * value;
        }
        sums[k] = sum;
    }
}

template <int D>
void AddedColumns<D>::see(const Coloured<double>& x) {
    product(x, x_);
}

template <int D>
void AddedColumns<D>::set_rhs() {
    for (std::size_t i = 0; i < given_.size(); ++i) (*b_)[more_->entries[i].cell] = given_[i];
    for (std::size_t k = 0; k < x_.size(); ++k) {
        const Row y = times(more_->blocks[k].C, x_[k]);
        for (std::size_t i = more_->blocks[k].begin; i < more_->blocks[k].end; ++i)
            (*b_)[more_->entries[i].cell] -= dot(more_->entries[i].u, y);
    }
}

template <int D>
real AddedColumns<D>::energy(const Coloured<float>& u) {
    product(u, u_);
    real sum = 0;
    for (std::size_t k = 0; k < u_.size(); ++k) sum += dot(u_[k], times(more_->blocks[k].C, u_[k]));
    return sum;
}

template <int D>
void AddedColumns<D>::update_direction(real beta) {
    for (std::size_t k = 0; k < p_.size(); ++k)
        for (std::size_t l = 0; l < LowRank::columns; ++l) p_[k][l] = u_[k][l] + beta * p_[k][l];
}

template <int D>
void AddedColumns<D>::move(real alpha) {
    for (std::size_t k = 0; k < p_.size(); ++k)
        for (std::size_t l = 0; l < LowRank::columns; ++l) x_[k][l] += alpha * p_[k][l];
}

template <int D>
void AddedColumns<D>::subtract_product(real alpha, const Coloured<float>& r) const {
    for (std::size_t k = 0; k < p_.size(); ++k) {
        const Row y = times(more_->blocks[k].C, p_[k]);
        for (std::size_t i = more_->blocks[k].begin; i < more_->blocks[k].end; ++i)
            r[places_[i].colour][places_[i].entry] -= static_cast<float>(alpha * dot(more_->entries[i].u, y));
    }
}

template <int D>
std::size_t AddedColumns<D>::bytes() const {
    return places_.capacity() * sizeof(Place) + given_.capacity() * sizeof(real) +
           (x_.capacity() + u_.capacity() + p_.capacity()) * sizeof(Row);
}

template class AddedColumns<2>;
template class AddedColumns<3>;

}  // namespace weir::poisson
