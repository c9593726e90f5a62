#include "waves/transposition.hpp"

#include <fftw3.h>

#include <algorithm>

namespace weir::waves {

namespace {

int count(const PlaneRange& range) { return range.end - range.begin; }
std::size_t area(const PlaneRange& a, const PlaneRange& b) {
    return static_cast<std::size_t>(count(a)) * static_cast<std::size_t>(count(b));
}

}  // namespace

void FreeAligned::operator()(void* at) const { fftw_free(at); }

template <class T>
Aligned<T> aligned(std::size_t count) {
    Aligned<T> made(static_cast<T*>(fftw_malloc(count * sizeof(T))));
    std::fill_n(made.get(), count, T{});
    return made;
}

OwnPlanes own_columns_of(int columns, const OwnPlanes& rows) {
    return rows.distributed() ? OwnPlanes(slab_of(partition_of_columns(columns, rows.partition().ranks()))) : OwnPlanes{};
}

PlaneRange held_columns(int columns, const OwnPlanes& rows) {
    if (!rows.distributed_storage()) return {0, columns};
    const OwnPlanes own = own_columns_of(columns, rows);
    return {own.lower(0), own.upper(columns)};
}

template <class T>
Transposition<T>::Transposition(int columns, int rows, const OwnPlanes& own)
    : column_count_(columns),
      row_count_(rows),
      by_row_(own),
      by_column_(own_columns_of(columns, own)),
      held_(held_columns(columns, own)),
      length_(padded(rows)),
      columns_(aligned<T>(length_ * static_cast<std::size_t>(std::max(1, count(held_))))) {}

template <class T>
void Transposition<T>::make_room() {
    const PlaneRange columns = own_columns(), rows = own_rows();
    turned_.resize(area(columns, {0, row_count_}) - area(columns, rows));
    others_.resize(area({0, column_count_}, rows) - area(columns, rows));
}

template <class T>
std::vector<typename Transposition<T>::Block> Transposition<T>::blocks() {
    const PlaneRange columns = own_columns(), rows = own_rows();
    std::vector<Block> list;
    std::size_t turned = 0, others = 0;
    for (int peer = 0; peer < communicator().ranks(); ++peer) {
        if (peer == communicator().rank()) continue;
        const std::size_t of_columns = area(columns, rows_of(peer)), of_rows = area(columns_of(peer), rows);
        list.push_back(
            {peer, rows_of(peer), turned_.data() + turned, others_.data() + others, of_columns * sizeof(T), of_rows * sizeof(T)});
        turned += of_columns, others += of_rows;
    }
    return list;
}

/// f(part of a column, its index in the block, length), column by column.
template <class T>
template <class F>
void Transposition<T>::each_part(const Block& block, const F& f) {
    const PlaneRange columns = own_columns();
    const auto each = static_cast<std::size_t>(count(block.rows));
    parallel_for(columns.begin, columns.end, [&](int m) {
        f(column(m) + block.rows.begin, block.of_columns + each * static_cast<std::size_t>(m - columns.begin), each);
    });
}

/// Sends to each rank its rows of this rank's columns.
template <class T>
void Transposition<T>::transpose() {
    make_room();
    std::vector<Message> messages;
    for (const Block& block : blocks()) {
        each_part(block, [](const T* part, T* place, std::size_t length) { std::copy_n(part, length, place); });
        messages.push_back({block.peer, block.of_columns, block.columns_bytes, block.of_rows, block.rows_bytes});
    }
    communicator().exchange(messages);
}

template <class T>
void Transposition<T>::transpose_back() {
    const std::vector<Block> list = blocks();
    std::vector<Message> messages;
    for (const Block& block : list)
        messages.push_back({block.peer, block.of_rows, block.rows_bytes, block.of_columns, block.columns_bytes});
    communicator().exchange(messages);
    for (const Block& block : list) each_part(block, [](T* part, const T* place, std::size_t length) { std::copy_n(place, length, part); });
}

/// This rank's rows of column m: own columns are stored here, those of other ranks are in blocks, in order.
template <class T>
T* Transposition<T>::own_rows_of(int m) {
    const PlaneRange rows = own_rows(), columns = own_columns();
    if (m >= columns.begin && m < columns.end) return column(m) + rows.begin;
    const int before = m < columns.begin ? m : m - count(columns);
    return others_.data() + static_cast<std::size_t>(before) * static_cast<std::size_t>(count(rows));
}

template <class T>
std::size_t Transposition<T>::bytes() const {
    return (length_ * static_cast<std::size_t>(count(held_)) + turned_.capacity() + others_.capacity()) * sizeof(T);
}

template Aligned<real> aligned<real>(std::size_t);
template Aligned<Complex> aligned<Complex>(std::size_t);
template class Transposition<real>;
template class Transposition<Complex>;

}  // namespace weir::waves
