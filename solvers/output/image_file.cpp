#include "output/image_file.hpp"

#include "core/error.hpp"
#include "core/words.hpp"
#include "output/atomic_file.hpp"

#ifdef WEIR_HAS_VTK
#include "output/png_read.hpp"

#include <vtkImageData.h>
#include <vtkJPEGWriter.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedCharArray.h>
#endif

namespace weir::output {

namespace {
constexpr const char* source_key = "Source";  // a standard key of the PNG specification
}  // namespace

bool was_made_as(const std::filesystem::path& png, const std::string& made_as) {
    try {
        const std::string bytes = bytes_of(png);
        return bytes.starts_with("\x89PNG") && bytes.find(std::string("tEXt") + source_key + '\0' + made_as) != std::string::npos;
    } catch (const BadInput&) {
        return false;
    }
}

#ifdef WEIR_HAS_VTK

namespace {

std::string bytes_in(vtkUnsignedCharArray& bytes) {
    return {reinterpret_cast<const char*>(bytes.GetPointer(0)), static_cast<std::size_t>(bytes.GetNumberOfValues())};
}

vtkSmartPointer<vtkImageData> image_of(int width, int height, const std::vector<std::uint8_t>& rgb) {
    auto image = vtkSmartPointer<vtkImageData>::New();
    image->SetDimensions(width, height, 1);
    image->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
    auto* to = static_cast<std::uint8_t*>(image->GetScalarPointer());
    const auto row = static_cast<std::size_t>(3 * width);
    for (int y = 0; y < height; ++y)  // VTK's images have the bottom row first, these the top row
        std::copy_n(rgb.data() + row * static_cast<std::size_t>(height - 1 - y), row, to + row * static_cast<std::size_t>(y));
    return image;
}

}  // namespace

void write_png(const std::filesystem::path& file, int width, int height, const std::vector<std::uint8_t>& rgb, const std::string& made_as) {
    vtkNew<vtkPNGWriter> writer;
    writer->SetInputData(image_of(width, height, rgb));
    if (!made_as.empty()) writer->AddText(source_key, made_as.c_str());
    writer->WriteToMemoryOn();
    writer->Write();
    write_file(file, bytes_in(*writer->GetResult()));
}

std::string jpeg_of(const std::filesystem::path& png) {
    const auto picture = read_png(png);
    if (!picture) return {};
    vtkNew<vtkJPEGWriter> writer;
    writer->SetInputData(image_of(picture->width, picture->height, picture->rgb));
    writer->SetQuality(88);
    writer->WriteToMemoryOn();
    writer->Write();
    return writer->GetErrorCode() == 0 && writer->GetResult() ? bytes_in(*writer->GetResult()) : std::string{};
}

#else

void write_png(const std::filesystem::path&, int, int, const std::vector<std::uint8_t>&, const std::string&) {
    throw BadInput("this weir was built without VTK (WEIR_VTK=OFF) and draws no pictures");
}
std::string jpeg_of(const std::filesystem::path&) { return {}; }

#endif

}  // namespace weir::output
