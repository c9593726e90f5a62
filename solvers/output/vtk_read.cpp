#include "output/vtk_read.hpp"

#include "core/error.hpp"
#include "core/words.hpp"
#include "output/silent_vtk.hpp"
#include "output/xml_tags.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include <vtkLZ4DataCompressor.h>
#include <vtkNew.h>
#include <vtkSmartPointer.h>
#include <vtkZLibDataCompressor.h>

namespace weir::output {

namespace {

constexpr std::size_t most_bytes = std::size_t{1} << 38;
constexpr std::uint64_t most_tuples = std::uint64_t{1} << 40;

std::size_t width_of(const std::string& type) {
    for (const auto& [known, width] : {std::pair{"Float64", 8}, {"Float32", 4}, {"Int64", 8}, {"Int32", 4}, {"UInt8", 1}})
        if (type == known) return static_cast<std::size_t>(width);
    return 0;
}

/// A data array as described in the header.
struct Announced {
    XmlTag tag;
    std::string name, type;
    std::size_t components, offset;
};

class Reader {
public:
    explicit Reader(const std::filesystem::path& path) : path_(path), bytes_(bytes_of(path, most_bytes)) {}

    ReadFile read() {
        const std::size_t data = bytes_.find("<AppendedData");
        if (data == std::string::npos) refuse("it has no appended data");
        header_ = std::string_view(bytes_).substr(0, data);
        std::size_t at = data;
        const XmlTag appended = next_tag(path_, bytes_, at);
        first_ = bytes_.find_first_not_of(" \n\r\t", at);
        if (appended.text("encoding") != "raw" || first_ == std::string::npos || bytes_[first_] != '_')
            refuse("its data are not appended raw");
        ++first_;
        end_ = bytes_.rfind("</AppendedData>");
        if (end_ == std::string::npos || end_ < first_ || bytes_.find("</VTKFile>", end_) == std::string::npos) refuse("it is cut off");
        read_file();
        return std::move(file_);
    }

private:
    [[noreturn]] void refuse(const std::string& what) const { throw BadInput(path_.string() + ": this frame is damaged: " + what); }

    XmlTag tag() { return next_tag(path_, header_, at_); }
    XmlTag need(const std::string& name, XmlTag::Kind kind = XmlTag::opens) {
        XmlTag found = tag();
        if (found.name != name || found.kind != kind) refuse("<" + found.name + "> stands where <" + name + "> is expected");
        return found;
    }

    void read_file() {
        const XmlTag file = need("VTKFile");
        const std::string type = file.text("type"), compressor = file.text("compressor");
        if (file.text("byte_order") != "LittleEndian") refuse("its byte order is \"" + Words::shown(file.text("byte_order")) + '"');
        wide_ = file.text("header_type") == "UInt64";
        if (!wide_ && file.text("header_type") != "UInt32") refuse("its header_type is \"" + Words::shown(file.text("header_type")) + '"');
        if (compressor == "vtkZLibDataCompressor") compressor_ = vtkSmartPointer<vtkZLibDataCompressor>::New();
        if (compressor == "vtkLZ4DataCompressor") compressor_ = vtkSmartPointer<vtkLZ4DataCompressor>::New();
        if (!compressor.empty() && !compressor_) refuse("its compressor is \"" + Words::shown(compressor) + '"');
        if (type != "ImageData" && type != "PolyData") refuse("it holds \"" + Words::shown(type) + '"');
        file_.image = type == "ImageData";
        const XmlTag whole = need(type);
        XmlTag next = tag();
        if (next.name == "FieldData" && next.kind == XmlTag::opens) skip_to_end_of("FieldData"), next = tag();
        if (next.name != "Piece" || next.kind != XmlTag::opens) refuse("<" + next.name + "> stands where <Piece> is expected");
        piece_ = next;
        if (file_.image) read_lattice(whole);
        for (next = tag(); next.kind == XmlTag::opens; next = tag()) read_element(next.name);
        if (next.name != "Piece" || next.kind != XmlTag::closes) refuse("<" + next.name + "> stands where </Piece> is expected");
        need(type, XmlTag::closes);
        if (!file_.image && file_.position.size() != 3 * count("NumberOfPoints")) refuse("it has no points");
        require_cells(file_.vertices, "NumberOfVerts"), require_cells(file_.lines, "NumberOfLines");
        require_cells(file_.polygons, "NumberOfPolys");
    }

    void skip_to_end_of(const std::string& name) {
        for (XmlTag next = tag(); next.name != name || next.kind != XmlTag::closes; next = tag()) {
        }
    }

    std::uint64_t count(const std::string& attribute) const {
        const std::uint64_t n = count_of(path_, piece_, attribute);
        if (n > most_tuples) refuse(attribute + " is " + piece_.text(attribute));
        return n;
    }

    void read_lattice(const XmlTag& whole) {
        const auto extent = numbers_of(path_, piece_, "Extent", 6);
        if (extent != numbers_of(path_, whole, "WholeExtent", 6)) refuse("its piece is not the whole");
        const auto origin = numbers_of(path_, whole, "Origin", 3), spacing = numbers_of(path_, whole, "Spacing", 3);
        for (std::size_t a = 0; a < 3; ++a) {
            const double low = extent[2 * a], high = extent[2 * a + 1];
            if (low != 0 || !(high >= 0 && high < 0x1p30) || high != std::floor(high))
                refuse("its extent is \"" + piece_.text("Extent") + '"');
            if (!(spacing[a] > 0)) refuse("its spacing is \"" + whole.text("Spacing") + '"');
            file_.points[a] = static_cast<int>(high) + 1, file_.origin[a] = origin[a], file_.spacing[a] = spacing[a];
        }
        if (tuples_of("CellData") > most_tuples) refuse("its extent is \"" + piece_.text("Extent") + '"');
    }

    /// Number of tuples of each array of an element.
    std::uint64_t tuples_of(const std::string& element) const {
        if (!file_.image) return element == "PointData" || element == "Points" ? count("NumberOfPoints") : 0;
        std::uint64_t all = 1;
        for (const int n : file_.points) {
            all *= static_cast<std::uint64_t>(element == "CellData" ? std::max(1, n - 1) : n);
            if (all > most_tuples) return all;
        }
        return all;
    }

    void read_element(const std::string& element) {
        std::vector<Announced> arrays;
        XmlTag next = tag();
        for (; next.name == "DataArray"; next = tag()) {
            if (next.kind == XmlTag::closes) refuse("</DataArray> stands alone");
            arrays.push_back(announced(next));
            if (next.kind == XmlTag::opens) skip_to_end_of("DataArray");  // VTK describes some arrays further
        }
        if (next.name != element || next.kind != XmlTag::closes) refuse("<" + next.name + "> stands where </" + element + "> is expected");
        if (element == "PointData" || element == "CellData") {
            auto& list = element == "CellData" ? file_.cell_data : file_.point_data;
            for (const Announced& a : arrays) list.push_back(array_of(a, tuples_of(element)));
        } else if (element == "Points" && arrays.size() == 1 && arrays[0].components == 3) {
            file_.position = array_of(arrays[0], tuples_of(element)).values;
        } else if (element == "Verts" || element == "Lines" || element == "Polys") {
            read_cells(arrays,
                       element == "Verts"   ? file_.vertices
                       : element == "Lines" ? file_.lines
                                            : file_.polygons,
                       count("NumberOf" + element));
        } else if (element != "Strips" || count("NumberOfStrips") != 0) {
            refuse("\"" + element + "\" is no part of a frame");
        }
    }

    Announced announced(const XmlTag& tag) const {
        Announced a{tag, tag.text("Name"), tag.text("type"), static_cast<std::size_t>(count_of(path_, tag, "NumberOfComponents", 1)),
                    static_cast<std::size_t>(count_of(path_, tag, "offset"))};
        if (width_of(a.type) == 0) refuse("the type of \"" + a.name + "\" is \"" + Words::shown(a.type) + '"');
        if (a.components < 1 || a.components > 9) refuse("\"" + a.name + "\" has " + std::to_string(a.components) + " components");
        if (a.name.empty() || tag.text("format") != "appended" || !tag.has("offset")) refuse("a data array has no name or no place");
        return a;
    }

    std::uint64_t header_number(std::size_t& at) const {
        const std::size_t width = wide_ ? 8 : 4;
        if (at > end_ || end_ - at < width) refuse("data lie beyond its end");
        std::uint64_t n = 0;
        std::memcpy(&n, bytes_.data() + at, width);
        at += width;
        return n;
    }

    /// The bytes of an array; for a list whose length is in its header, any number.
    std::string raw(const Announced& a, std::uint64_t wanted, bool any) const {
        if (a.offset > end_ - first_) refuse("\"" + a.name + "\" lies beyond its end");
        std::size_t at = first_ + a.offset;
        const auto wrong = [&](std::uint64_t there) {
            refuse("\"" + a.name + "\" has " + std::to_string(there) + " bytes; " + std::to_string(wanted) + " are expected");
        };
        if (!compressor_) {
            const std::uint64_t there = header_number(at);
            if (there > end_ - at) refuse("\"" + a.name + "\" lies beyond its end");
            if (!any && there != wanted) wrong(there);
            return bytes_.substr(at, there);
        }
        const std::uint64_t blocks = header_number(at), block = header_number(at), last = header_number(at);
        if (blocks == 0) return any || wanted == 0 ? std::string() : (wrong(0), std::string());
        constexpr std::uint64_t largest = std::uint64_t{1} << 30, ratio = 1100;  // zlib's maximum is 1032, LZ4's 255
        if (blocks > (end_ - at) / (wide_ ? 8 : 4) || block < 1 || block > largest || last >= block || blocks > 2 * most_bytes / block)
            refuse("the blocks of \"" + a.name + "\" have no size");
        const std::uint64_t all = last > 0 ? (blocks - 1) * block + last : blocks * block;
        if (!any && all != wanted) wrong(all);
        if (all / ratio > end_ - at) refuse("\"" + a.name + "\" has more bytes than its data can hold");
        std::string bytes(all, '\0');
        std::size_t sizes = at, from = at + blocks * (wide_ ? 8 : 4);
        for (std::uint64_t b = 0; b < blocks; ++b) {
            const std::uint64_t size = header_number(sizes), begin = b * block, length = std::min(block, all - begin);
            if (from > end_ || size > end_ - from) refuse("\"" + a.name + "\" lies beyond its end");
            const auto got = compressor_->Uncompress(reinterpret_cast<const unsigned char*>(bytes_.data() + from), size,
                                                     reinterpret_cast<unsigned char*>(bytes.data() + begin), length);
            if (got != length) refuse("block " + std::to_string(b) + " of \"" + a.name + "\" cannot be decompressed");
            from += size;
        }
        return bytes;
    }

    template <class T, class To>
    static void copy(const std::string& bytes, std::vector<To>& to) {
        to.resize(bytes.size() / sizeof(T));
        for (std::size_t i = 0; i < to.size(); ++i) {
            T value;
            std::memcpy(&value, bytes.data() + i * sizeof(T), sizeof(T));
            to[i] = static_cast<To>(value);
        }
    }

    ReadArray array_of(const Announced& a, std::uint64_t tuples) const {
        ReadArray array{.name = a.name, .components = a.components, .bytes = a.type == "UInt8"};
        const std::string bytes = raw(a, tuples * a.components * width_of(a.type), false);
        if (a.type == "Float64") copy<double>(bytes, array.values);
        if (a.type == "Float32") copy<float>(bytes, array.values);
        if (a.type == "Int64") copy<std::int64_t>(bytes, array.values);
        if (a.type == "Int32") copy<std::int32_t>(bytes, array.values);
        if (a.type == "UInt8") copy<std::uint8_t>(bytes, array.values);
        for (const real value : array.values)
            if (!std::isfinite(value)) refuse("\"" + a.name + "\" holds a value that is not finite");
        return array;
    }

    void read_cells(const std::vector<Announced>& arrays, ReadCells& cells, std::uint64_t number) const {
        for (const Announced& a : arrays) {
            if (a.type != "Int64" || (a.name != "connectivity" && a.name != "offsets")) refuse("\"" + a.name + "\" is no list of corners");
            const bool ends = a.name == "offsets";
            copy<std::int64_t>(raw(a, 8 * number, !ends), ends ? cells.ends : cells.corners);
        }
    }

    void require_cells(const ReadCells& cells, const std::string& number) const {
        std::int64_t before = 0;
        const auto corners = static_cast<std::int64_t>(cells.corners.size());
        for (const std::int64_t end : cells.ends) {
            if (end <= before || end > corners) refuse("the cells of " + number + " have no order");
            before = end;
        }
        if (before != corners || (!file_.image && cells.ends.size() != count(number))) refuse("its cells are not " + number);
        const auto points = static_cast<std::int64_t>(file_.position.size() / 3);
        for (const std::int64_t corner : cells.corners)
            if (corner < 0 || corner >= points) refuse("a cell has the corner " + std::to_string(corner) + " of " + std::to_string(points));
    }

    std::filesystem::path path_;
    std::string bytes_;
    std::string_view header_;
    std::size_t at_ = 0, first_ = 0, end_ = 0;
    bool wide_ = false;
    vtkSmartPointer<vtkDataCompressor> compressor_;
    XmlTag piece_;
    ReadFile file_;
};

}  // namespace

ReadFile read_vtk(const std::filesystem::path& file) {
    static_assert(std::endian::native == std::endian::little);
    const SilentVtk silent;
    return Reader(file).read();
}

}  // namespace weir::output
