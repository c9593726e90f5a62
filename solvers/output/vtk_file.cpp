#include "output/vtk_file.hpp"

#include "core/error.hpp"
#include "output/array_blocks.hpp"
#include "output/atomic_file.hpp"

#include <cstdio>
#include <exception>
#include <limits>
#include <optional>

namespace weir::output {

namespace {

/// The file written by rank 0; the other ranks send their parts. Errors are reported at the end, since all ranks must complete the
/// exchange.
class Destination {
public:
    Destination(const std::filesystem::path& path, std::size_t room_for_text) : data_(room_for_text) {
        if (communicator().rank() > 0) return;
        attempt([&] { file_.emplace(path); });
        put(std::string(room_for_text, ' '));
    }
    void put(std::string_view bytes) {
        attempt([&] { file_->write(bytes); });
        written_ += bytes.size();
    }
    /// All ranks' parts of an array, in rank order; no communication where rank 0 has all.
    template <class List>
    void put_parts(const DataArray& array, const List& own) {
        const std::size_t bytes = own.size() * sizeof(own[0]);
        const auto sink = [&](const void* data, std::size_t count) { put({static_cast<const char*>(data), count}); };
        if (array.tuples.all_on_first())
            sink(own.data(), bytes);
        else
            communicator().stream_to_first(own.data(), bytes, sink);
    }
    template <class T>
    void put_number(T number) {
        put({reinterpret_cast<const char*>(&number), sizeof number});
    }
    /// Offset from the first byte of data.
    std::size_t position() const { return written_ - data_; }
    void finish(const std::string& text) {
        by_first_rank([&] {
            attempt([&] { file_->write_over_start(text), file_->finish(); });
            file_.reset();
            if (failure_) std::rethrow_exception(failure_);
        });
    }

private:
    template <class F>
    void attempt(F&& f) {
        if (communicator().rank() > 0 || failure_) return;
        try {
            f();
        } catch (...) {
            failure_ = std::current_exception();
        }
    }

    std::optional<NewFile> file_;
    std::size_t data_, written_ = 0;
    std::exception_ptr failure_;
};

/// The offset of an array's data, and its extremes.
struct Placed {
    std::size_t offset = 0;
    Extremes extremes{};
};

std::string number_text(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.11g", value);
    return text;
}

/// Headers are 32-bit numbers.
std::uint32_t header_number(std::size_t value) {
    if (value > std::numeric_limits<std::uint32_t>::max())
        throw OutputError("a field of 4 GB and more needs output.compression = \"zlib\" or \"lz4\"");
    return static_cast<std::uint32_t>(value);
}

Placed place(Destination& file, const DataArray& array, Compression compression) {
    const std::size_t bytes = array.tuples.all() * static_cast<std::size_t>(array.components) * array.bytes_of_number;
    const Placed placed{file.position(), array.tells_extremes ? extremes_of(array) : Extremes{}};
    const EncodedPart own = encoded_part(array, compression);
    if (compression == Compression::none) {
        file.put_number(header_number(bytes));
    } else {
        file.put_number(header_number((bytes + bytes_of_block - 1) / bytes_of_block));
        file.put_number(header_number(bytes_of_block));
        file.put_number(header_number(bytes % bytes_of_block));
        file.put_parts(array, own.sizes);
    }
    file.put_parts(array, own.bytes);
    return placed;
}

/// VTK's description of an array, in one or several lines.
std::string array_text(const DataArray& array, const Placed& placed, const std::string& indent, bool with_number) {
    std::string text = indent + "<DataArray type=\"" + array.type + "\" Name=\"" + array.name + '"';
    if (array.components > 1) text += " NumberOfComponents=\"" + std::to_string(array.components) + '"';
    if (with_number) text += " NumberOfTuples=\"" + std::to_string(array.tuples.all()) + '"';
    const auto extreme = [&](double value) { return array.tells_extremes ? number_text(value) : std::string(); };
    text += " format=\"appended\"" + with_room("RangeMin", extreme(placed.extremes.least)) +
            with_room("RangeMax", extreme(placed.extremes.most)) + with_room("offset", std::to_string(placed.offset));
    return text + "/>\n";
}

/// The whole text before the data; its length does not depend on their offsets.
std::string text_of(const VtkFile& file, Compression compression, const std::vector<Placed>& placed) {
    auto next = placed.begin();
    const DataArray time = data_array<double>("TimeValue", 1, Parts::of_first(1), [t = file.time](std::size_t, int) { return t; });
    std::string text =
        "<VTKFile type=\"" + file.type + "\" version=\"" + file.version + "\" byte_order=\"LittleEndian\" header_type=\"UInt32\"";
    if (compression == Compression::zlib) text += " compressor=\"vtkZLibDataCompressor\"";
    if (compression == Compression::lz4) text += " compressor=\"vtkLZ4DataCompressor\"";
    text +=
        ">\n  <" + file.type + file.attributes + ">\n    <FieldData>\n" + array_text(time, *next++, "      ", true) + "    </FieldData>\n";
    text += "    <Piece" + file.piece + ">\n";
    for (const VtkElement& element : file.elements) {
        text += "      <" + element.name + element.attributes + ">\n";
        for (const DataArray& array : element.arrays) text += array_text(array, *next++, "        ", false);
        text += "      </" + element.name + ">\n";
    }
    return text + "    </Piece>\n  </" + file.type + ">\n  <AppendedData encoding=\"raw\">\n   _";
}

}  // namespace

std::string with_room(const std::string& name, const std::string& value, std::size_t room) {
    return ' ' + name + "=\"" + value + '"' + std::string(room - std::min(room, value.size()), ' ');
}

void write(const std::filesystem::path& path, const VtkFile& file, Compression compression) {
    const DataArray time = data_array<double>("TimeValue", 1, Parts::of_first(1), [t = file.time](std::size_t, int) { return t; });
    std::vector<const DataArray*> arrays{&time};
    for (const VtkElement& element : file.elements)
        for (const DataArray& array : element.arrays) arrays.push_back(&array);
    std::vector<Placed> placed(arrays.size());
    Destination destination(path, text_of(file, compression, placed).size());
    for (std::size_t a = 0; a < arrays.size(); ++a) placed[a] = place(destination, *arrays[a], compression);
    destination.put("\n  </AppendedData>\n</VTKFile>\n");
    destination.finish(text_of(file, compression, placed));
}

}  // namespace weir::output
