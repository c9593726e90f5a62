// The frames of a run as VTK's own data, and the names by which they can be coloured.
#pragma once
#include "core/types.hpp"

#include <vtkDataSet.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace weir::view {

struct Frame {
    real time = 0;                                                  // [s]
    vtkSmartPointer<vtkImageData> grid;                             // null where the run has no grid
    std::map<std::string, vtkSmartPointer<vtkPolyData>> particles;  // by set: "markers", "particles"
};

class Series {
public:
    /// Throws BadInput where `folder` holds no frames.
    explicit Series(std::filesystem::path folder);
    std::size_t size() const { return times_.size(); }
    const std::vector<real>& times() const { return times_; }
    const std::filesystem::path& folder() const { return folder_; }
    /// Throws BadInput naming the file that cannot be read.
    Frame read(std::size_t number) const;

private:
    std::filesystem::path folder_;
    std::vector<real> times_;
};

/// What a frame can be coloured by: fields of the grid, then of particles; "speed" stands for a velocity. Empty where there is none.
std::vector<std::string> field_names(const Frame& frame);

/// The grid's field as one number a cell; null where it has none of this name.
vtkSmartPointer<vtkFloatArray> numbers_of_cells(const Frame& frame, const std::string& field);

/// The field's values at the points of `data` as one number each, as the active scalars of a copy: its own, or the grid's sampled there.
/// Null where neither has it.
vtkSmartPointer<vtkDataSet> coloured(vtkDataSet* data, const Frame& frame, const std::string& field);

}  // namespace weir::view
