// Readers of STL, OBJ and PLY. They are implemented here because input files may be damaged anywhere: VTK 9.1 aborts the program at a PLY
// file that ends early, reads a word as the number 0 and accepts corners with invalid point indices.
#include "core/error.hpp"
#include "core/words.hpp"
#include "geometry/mesh/triangles.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace weir::geometry {

namespace {

void refuse_many(const std::string& name, double count) {
    if (count > static_cast<double>(most_triangles))
        throw BadInput(name + ": " + std::to_string(static_cast<long long>(count)) + " triangles; at most " +
                       std::to_string(most_triangles) + " are read, more than a grid of distances can show");
}

/// Numbers in a binary file.
template <class T>
T number_at(const std::string& bytes, std::size_t at, bool swapped) {
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), bytes.data() + at, sizeof(T));
    if (swapped) std::reverse(raw.begin(), raw.end());
    return std::bit_cast<T>(raw);
}
constexpr bool big_machine = std::endian::native == std::endian::big;

Vec<3> point(Words& words) {
    Vec<3> x;
    for (int a = 0; a < 3; ++a) x[a] = words.number("a coordinate");
    return x;
}

/// A polygon as a fan of triangles; corners are point indices from 0.
void add_face(const std::vector<int>& face, Triangles& mesh) {
    for (std::size_t i = 2; i < face.size(); ++i) mesh.corners.push_back({face[0], face[i - 1], face[i]});
}

Triangles stl_of_bytes(const std::string& bytes, std::size_t count, const std::string& name) {
    Triangles mesh;
    mesh.points.reserve(3 * count), mesh.corners.reserve(count);
    for (std::size_t t = 0; t < count; ++t) {
        const int first = static_cast<int>(mesh.points.size());
        for (std::size_t c = 0; c < 3; ++c) {
            Vec<3> x;
            for (std::size_t a = 0; a < 3; ++a) x[a] = number_at<float>(bytes, 84 + 50 * t + 12 + 12 * c + 4 * a, big_machine);
            if (!std::isfinite(norm(x))) throw BadInput(name + ": triangle " + std::to_string(t) + " has a corner that is no number");
            mesh.points.push_back(x);
        }
        mesh.corners.push_back({first, first + 1, first + 2});
    }
    return mesh;
}

Triangles stl_of_text(Words words) {
    Triangles mesh;
    const auto need = [&](const char* word) {
        if (const auto found = words.next(); found != word)
            words.fail(found.empty() ? "the file ends where \"" + std::string(word) + "\" is expected"
                                     : '"' + Words::shown(found) + "\" stands where \"" + word + "\" is expected");
    };
    while (!words.peek().empty()) {  // a file may contain several solids
        need("solid");
        words.skip_line();
        for (; words.peek() == "facet"; need("endfacet")) {
            need("facet"), need("normal"), point(words), need("outer"), need("loop");
            const int first = static_cast<int>(mesh.points.size());
            for (int c = 0; c < 3; ++c) need("vertex"), mesh.points.push_back(point(words));
            need("endloop");
            mesh.corners.push_back({first, first + 1, first + 2});
        }
        need("endsolid");
        words.skip_line();
    }
    return mesh;
}

Triangles read_stl(const std::filesystem::path& file) {
    const std::string bytes = bytes_of(file), name = file.string();
    const bool words = bytes.starts_with("solid");
    if (bytes.size() >= 84) {
        const std::size_t count = number_at<std::uint32_t>(bytes, 80, big_machine), whole = 84 + 50 * count;
        if (!words || bytes.size() == whole) {
            refuse_many(name, static_cast<double>(count));
            if (bytes.size() != whole)
                throw BadInput(name + ": " + std::to_string(count) + " triangles take " + std::to_string(whole) + " bytes; the file has " +
                               std::to_string(bytes.size()));
            return stl_of_bytes(bytes, count, name);
        }
    }
    if (!words) throw BadInput(name + ": no STL file: neither \"solid\" nor a count of triangles stands at its beginning");
    return stl_of_text(Words(file, bytes, false));
}

Triangles read_obj(const std::filesystem::path& file) {
    const std::string bytes = bytes_of(file);
    Words words(file, bytes, true);
    Triangles mesh;
    std::vector<int> face;
    for (std::string_view tag = words.next(); !tag.empty(); words.skip_line(), tag = words.next()) {
        if (tag == "v") {
            Vec<3> x;
            for (int a = 0; a < 3; ++a) x[a] = words.number_in(words.next_of_line(), "a coordinate");
            mesh.points.push_back(x);
            Vec<3> rgb;
            int colours = 0;  // many programs write red, green and blue after the position
            for (auto word = words.next_of_line(); !word.empty() && colours < 3; word = words.next_of_line())
                rgb[colours++] = words.number_in(word, "a colour");
            if (colours == 3) mesh.colours.push_back(rgb);
        } else if (tag == "f") {
            face.clear();
            for (auto word = words.next_of_line(); !word.empty(); word = words.next_of_line()) {
                const real n = words.number_in(word.substr(0, word.find('/')), "the number of a point");
                const real count = static_cast<real>(mesh.points.size()), index = n > 0 ? n - 1 : count + n;
                if (!(index >= 0 && index < count) || index != std::floor(index))
                    words.fail("a face names point " + Words::shown(word) + "; " + std::to_string(mesh.points.size()) + " stand before it");
                face.push_back(static_cast<int>(index));
            }
            if (face.size() < 3) words.fail("a face has three corners at least");
            add_face(face, mesh);
            refuse_many(file.string(), static_cast<double>(mesh.corners.size()));
        }
    }
    if (mesh.colours.size() != mesh.points.size()) mesh.colours.clear();
    return mesh;
}

/// One property of a PLY element: a number, or a list of them.
struct Property {
    std::string name, type, count;  // count: the type of a list's length; empty: not a list
};
struct Element {
    std::string name;
    std::size_t count = 0;
    std::vector<Property> properties;
};

class Ply {
public:
    explicit Ply(const std::filesystem::path& file) : name_(file.string()), bytes_(bytes_of(file)), words_(file, bytes_, false) {}

    Triangles read() {
        header();
        Triangles mesh;
        std::vector<int> face;
        for (const Element& element : elements_)
            for (std::size_t i = 0; i < element.count; ++i) {
                Vec<3> x{}, rgb{};
                face.clear();
                for (const Property& p : element.properties) {
                    const std::size_t n = p.count.empty() ? 1 : length(p.count);
                    const bool corners = !p.count.empty() && (p.name == "vertex_indices" || p.name == "vertex_index");
                    for (std::size_t k = 0; k < n; ++k) {
                        const real value = number(p.type);
                        if (corners) face.push_back(corner(value, mesh.points.size()));
                        for (int a = 0; a < 3; ++a) {
                            if (p.name == std::string(1, "xyz"[a])) x[a] = value;
                            if (p.name == std::array{"red", "green", "blue"}[static_cast<std::size_t>(a)])
                                rgb[a] = p.type == "uchar" || p.type == "uint8" ? value / 255 : value;
                        }
                    }
                }
                if (element.name == "vertex") mesh.points.push_back(x);
                if (element.name == "vertex" && coloured_) mesh.colours.push_back(rgb);
                if (element.name == "face") add_face(face, mesh), refuse_many(name_, static_cast<double>(mesh.corners.size()));
            }
        return mesh;
    }

private:
    static std::size_t size_of(const std::string& type) {
        for (const auto& [names, size] : {std::pair{" char uchar int8 uint8 ", 1}, std::pair{" short ushort int16 uint16 ", 2},
                                          std::pair{" int uint int32 uint32 float float32 ", 4}, std::pair{" double float64 ", 8}})
            if (std::string_view(names).find(' ' + type + ' ') != std::string_view::npos) return static_cast<std::size_t>(size);
        return 0;
    }

    std::string type() {
        const std::string word(words_.next_of_line());
        if (size_of(word) == 0)
            words_.fail('"' + Words::shown(word) +
                        "\" is no type of a property; known: char, uchar, short, ushort, "
                        "int, uint, float, double");
        return word;
    }

    void header() {
        if (words_.next() != "ply") words_.fail("no PLY file: \"ply\" does not stand at its beginning");
        bool format = false;
        for (;;) {
            const std::string_view word = words_.next();
            if (word == "end_header") break;
            if (word == "format") {
                const std::string_view kind = words_.next_of_line();
                text_ = kind == "ascii", swapped_ = (kind == "binary_big_endian") != big_machine, format = true;
                if (!text_ && kind != "binary_big_endian" && kind != "binary_little_endian")
                    words_.fail('"' + Words::shown(kind) + "\" is no format; known: ascii, binary_big_endian, binary_little_endian");
            } else if (word == "element") {
                elements_.push_back({std::string(words_.next_of_line()), 0, {}});
                const real count = words_.number_in(words_.next_of_line(), "a count");
                if (!(count >= 0 && count < 4e9 && count == std::floor(count))) words_.fail("a count is a whole number");
                elements_.back().count = static_cast<std::size_t>(count);
                if (elements_.back().name == "face") refuse_many(name_, count);
            } else if (word == "property") {
                if (elements_.empty()) words_.fail("a property stands before any element");
                Property p;
                p.type = std::string(words_.next_of_line());
                if (p.type == "list")
                    p.count = type(), p.type = type();
                else if (size_of(p.type) == 0)
                    words_.fail('"' + Words::shown(p.type) +
                                "\" is no type of a property; known: char, uchar, short, ushort, int, uint, "
                                "float, double, list");
                p.name = std::string(words_.next_of_line());
                if (elements_.back().name == "vertex" && p.name == "red") coloured_ = true;
                elements_.back().properties.push_back(p);
            } else if (word != "comment" && word != "obj_info") {
                words_.fail(word.empty() ? "the header has no end" : '"' + Words::shown(word) + "\" is no word of a PLY header");
            }
            words_.skip_line();
        }
        if (!format) words_.fail("the header names no format");
        words_.skip_line();
        at_ = words_.position();
        require_elements();
    }

    /// Elements without properties take no bytes of the file, so their count would be unbounded.
    void require_elements() const {
        for (const Element& element : elements_)
            if (element.count > 0 && element.properties.empty())
                throw BadInput(name_ + ": the header announces " + std::to_string(element.count) + " elements \"" +
                               Words::shown(element.name) + "\" without a property");
        for (const Element& element : elements_)
            for (const char* axis : {"x", "y", "z"})
                if (element.name == "vertex" && std::none_of(element.properties.begin(), element.properties.end(),
                                                             [&](const Property& p) { return p.name == axis && p.count.empty(); }))
                    throw BadInput(name_ + ": the header announces vertices without a property \"" + axis + '"');
    }

    real number(const std::string& type) {
        if (text_) return words_.number("a number");
        const std::size_t size = size_of(type), at = at_;
        if (bytes_.size() - at < size)
            throw BadInput(name_ + ": the file ends after " + std::to_string(bytes_.size()) + " bytes, within its data");
        at_ += size;
        const bool is_signed = type[0] != 'u';
        real value = 0;
        if (size == 8)
            value = number_at<double>(bytes_, at, swapped_);
        else if (type.starts_with("float"))
            value = number_at<float>(bytes_, at, swapped_);
        else if (size == 4)
            value = is_signed ? number_at<std::int32_t>(bytes_, at, swapped_) : number_at<std::uint32_t>(bytes_, at, swapped_);
        else if (size == 2)
            value = is_signed ? number_at<std::int16_t>(bytes_, at, swapped_) : number_at<std::uint16_t>(bytes_, at, swapped_);
        else
            value = is_signed ? number_at<std::int8_t>(bytes_, at, swapped_) : number_at<std::uint8_t>(bytes_, at, swapped_);
        if (!std::isfinite(value)) throw BadInput(name_ + ": the value at byte " + std::to_string(at) + " is no number");
        return value;
    }

    std::size_t length(const std::string& type) {
        const real n = number(type);
        if (!(n >= 0 && n <= 1e6 && n == std::floor(n))) bad("a list of " + std::to_string(n) + " entries");
        return static_cast<std::size_t>(n);
    }

    int corner(real value, std::size_t points) const {
        if (!(value >= 0 && value < static_cast<real>(points) && value == std::floor(value)))
            bad("a face names point " + std::to_string(static_cast<long long>(value)) + "; there are " + std::to_string(points) +
                ", from 0");
        return static_cast<int>(value);
    }

    [[noreturn]] void bad(const std::string& what) const {
        if (text_) words_.fail(what);
        throw BadInput(name_ + ": byte " + std::to_string(at_) + ": " + what);
    }

    std::string name_, bytes_;
    Words words_;
    std::vector<Element> elements_;
    bool text_ = true, swapped_ = false, coloured_ = false;
    std::size_t at_ = 0;
};

}  // namespace

Triangles read_triangles(const std::filesystem::path& file) {
    std::string ending = file.extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (ending != ".stl" && ending != ".obj" && ending != ".ply")
        throw BadInput(file.string() + ": its name says no format of meshes; known: .obj, .ply, .stl");
    std::error_code failed;
    if (!std::filesystem::exists(file, failed) && !failed) throw BadInput(file.string() + ": there is no such file");
    if (ending == ".stl") return read_stl(file);
    if (ending == ".obj") return read_obj(file);
    return Ply(file).read();
}

}  // namespace weir::geometry
