#include "output/image_file.hpp"

#include "core/error.hpp"
#include "output/atomic_file.hpp"

#ifdef WEIR_HAS_VTK
#include <vtkImageData.h>
#include <vtkJPEGWriter.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>
#include <vtkPNGWriter.h>
#include <vtkUnsignedCharArray.h>
#endif

namespace weir::output {

#ifdef WEIR_HAS_VTK

namespace {

std::string bytes_in(vtkUnsignedCharArray& bytes) {
    return {reinterpret_cast<const char*>(bytes.GetPointer(0)), static_cast<std::size_t>(bytes.GetNumberOfValues())};
}

}  // namespace

void write_png(const std::filesystem::path& file, int width, int height, const std::vector<std::uint8_t>& rgb) {
    vtkNew<vtkImageData> image;
    image->SetDimensions(width, height, 1);
    image->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
    auto* to = static_cast<std::uint8_t*>(image->GetScalarPointer());
    const auto row = static_cast<std::size_t>(3 * width);
    for (int y = 0; y < height; ++y)  // VTK's images stand on their feet, ours hang from the top
        std::copy_n(rgb.data() + row * static_cast<std::size_t>(height - 1 - y), row, to + row * static_cast<std::size_t>(y));
    vtkNew<vtkPNGWriter> writer;
    writer->SetInputData(image);
    writer->WriteToMemoryOn();
    writer->Write();
    write_file(file, bytes_in(*writer->GetResult()));
}

std::string jpeg_of(const std::filesystem::path& png) {
    vtkNew<vtkPNGReader> reader;
    if (!reader->CanReadFile(png.c_str())) return {};
    reader->SetFileName(png.c_str());
    vtkNew<vtkJPEGWriter> writer;
    writer->SetInputConnection(reader->GetOutputPort());
    writer->SetQuality(88);
    writer->WriteToMemoryOn();
    writer->Write();
    return writer->GetErrorCode() == 0 && writer->GetResult() ? bytes_in(*writer->GetResult()) : std::string{};
}

#else

void write_png(const std::filesystem::path&, int, int, const std::vector<std::uint8_t>&) {
    throw BadInput("this weir was built without VTK (WEIR_VTK=OFF) and draws no pictures");
}
std::string jpeg_of(const std::filesystem::path&) { return {}; }

#endif

}  // namespace weir::output
