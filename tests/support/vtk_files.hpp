// Frames read back by VTK's own readers. VTK's complaints about unreadable files become test failures.
#pragma once
#include "output/series_file.hpp"

#include <filesystem>
#include <stdexcept>
#include <string>

#include <vtkDataSet.h>
#include <vtkImageData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLPolyDataReader.h>

namespace weir::test {

template <class Reader>
auto read_vtk(const std::filesystem::path& file) {
    auto reader = vtkSmartPointer<Reader>::New();
    if (!reader->CanReadFile(file.c_str())) throw std::runtime_error("VTK cannot read " + file.string());
    reader->SetFileName(file.c_str());
    reader->Update();
    if (reader->GetErrorCode() != 0) throw std::runtime_error("VTK fails on " + file.string());
    using Data = std::remove_pointer_t<decltype(reader->GetOutput())>;
    return vtkSmartPointer<Data>(reader->GetOutput());
}
inline auto read_image(const std::filesystem::path& file) { return read_vtk<vtkXMLImageDataReader>(file); }
inline auto read_particles(const std::filesystem::path& file) { return read_vtk<vtkXMLPolyDataReader>(file); }

/// Opens every frame of a series; returns how many there are. Throws when one is missing, broken or empty of data.
inline int read_whole_series(const std::filesystem::path& pvd) {
    int frames = 0;
    for (const auto& entry : output::read_series(pvd)) {
        const auto file = pvd.parent_path() / entry.file;
        vtkSmartPointer<vtkDataSet> data;
        if (file.extension() == ".vti")
            data = read_image(file);
        else
            data = read_particles(file);
        if (data->GetNumberOfPoints() == 0) throw std::runtime_error(file.string() + " is empty");
        ++frames;
    }
    return frames;
}

}  // namespace weir::test
