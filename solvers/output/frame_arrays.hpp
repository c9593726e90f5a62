// The selected fields of a frame as arrays, for any format. In parallel with distributed storage each rank provides its part; fields stored
// whole are provided by rank 0.
#pragma once
#include "core/solver.hpp"
#include "output/data_array.hpp"
#include "output/frame_format.hpp"

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace weir::output {

/// Returns whether `options` select this field.
bool chosen(const FrameOptions& options, const FieldView& field);
/// Returns whether `options` select a field of the grid; faces_only: one on its faces.
bool has_grid_fields(const FieldSet& fields, const FrameOptions& options, bool faces_only = false);
/// Particle sets of these fields, in the order in which they appear.
std::vector<std::string> particle_sets(const FieldSet& fields);

/// The partition of the planes of an array, with `entries` elements per plane; all on rank 0, where all ranks store whole fields.
Parts parts_of_planes(const FieldSet& fields, std::size_t entries, int planes);
/// The same for an array with these extents.
Parts parts_of_grid(const FieldSet& fields, const std::array<int, 3>& n);

/// Values in the precision of `options`.
template <class Value>
DataArray real_array(const FrameOptions& options, std::string name, int components, const Parts& tuples, Value value) {
    if (options.single_precision) return data_array<float>(std::move(name), components, tuples, std::move(value));
    return data_array<double>(std::move(name), components, tuples, std::move(value));
}

/// The elements of a field; for a part of the particles, starting at global index `first`. Vectors have three components for any dimension:
/// the third is zero in 2D.
DataArray field_array(const FieldView& field, const Parts& tuples, const FrameOptions& options, std::size_t first = 0);
/// Every selected field of the grid with a value per cell, x fastest. Face fields are interpolated to the cells' centres, as vectors of
/// three components.
std::vector<DataArray> cell_arrays(const FieldSet& fields, const FrameOptions& options);

}  // namespace weir::output
