#include "output/array_blocks.hpp"

#include "core/error.hpp"
#include "core/parallel.hpp"

#include <cstring>
#include <functional>

#ifdef WEIR_HAS_VTK
#include <vtkLZ4DataCompressor.h>
#include <vtkSmartPointer.h>
#include <vtkZLibDataCompressor.h>
#endif

namespace weir::output {

namespace {

/// Indices of array elements: [first, last) belong to this rank, and the blocks [begin, end) start there.
struct OwnBlocks {
    std::size_t in_block, all, first, last, begin, end;

    explicit OwnBlocks(const DataArray& array) : OwnBlocks(array, communicator().rank()) {}
    OwnBlocks(const DataArray& array, int rank)
        : in_block(bytes_of_block / array.bytes_of_number),
          all(components(array) * array.tuples.all()),
          first(components(array) * array.tuples.begin(rank)),
          last(components(array) * array.tuples.end(rank)),
          begin((first + in_block - 1) / in_block),
          end((last + in_block - 1) / in_block) {}
    /// End of this part's elements that belong to a block started by another rank.
    std::size_t head_end() const { return std::min(last, begin * in_block); }
    /// End of the elements of other ranks in this rank's last block.
    std::size_t tail_end() const { return begin < end ? std::min(all, end * in_block) : last; }

private:
    static std::size_t components(const DataArray& array) { return static_cast<std::size_t>(array.components); }
};

/// The elements after this rank's part that belong to its last block, received from their ranks.
std::vector<std::byte> tail_of(const DataArray& array) {
    const OwnBlocks own(array);
    std::vector<std::byte> tail((own.tail_end() - own.last) * array.bytes_of_number),
        head((own.head_end() - own.first) * array.bytes_of_number);
    std::vector<Message> messages;
    if (!head.empty()) {
        array.numbers->copy(own.first, own.head_end() - own.first, head.data());
        const auto began_it = [&](int rank) {
            const OwnBlocks before(array, rank);
            return before.begin < own.begin && own.begin <= before.end;
        };
        int owner = communicator().rank() - 1;
        while (!began_it(owner)) --owner;
        messages.push_back({owner, head.data(), head.size(), nullptr, 0});
    }
    for (int rank = communicator().rank() + 1; rank < communicator().ranks(); ++rank) {
        const OwnBlocks next(array, rank);
        const std::size_t begin = next.first, end = std::min(next.last, own.tail_end());
        if (begin >= end) continue;
        messages.push_back(
            {rank, nullptr, 0, tail.data() + (begin - own.last) * array.bytes_of_number, (end - begin) * array.bytes_of_number});
    }
    communicator().exchange(messages);
    return tail;
}

#ifdef WEIR_HAS_VTK
/// VTK's compressor, for a single thread.
vtkSmartPointer<vtkDataCompressor> compressor_of(Compression compression) {
    if (compression == Compression::lz4) {
        auto lz4 = vtkSmartPointer<vtkLZ4DataCompressor>::New();
        lz4->SetCompressionLevel(5);  // the default of VTK's writers
        return lz4;
    }
    auto zlib = vtkSmartPointer<vtkZLibDataCompressor>::New();
    zlib->SetCompressionLevel(1);  // higher levels take several times as long for noise-like doubles and gain a few per cent
    return zlib;
}

EncodedPart compressed_part(const DataArray& array, Compression compression) {
    constexpr std::size_t of_thread = 8;  // number of blocks at once
    const OwnBlocks own(array);
    const std::vector<std::byte> tail = tail_of(array);
    std::vector<vtkSmartPointer<vtkDataCompressor>> compressors;
    for (int thread = 0; thread < threads(); ++thread) compressors.push_back(compressor_of(compression));
    const std::size_t room = compressors[0]->GetMaximumCompressionSpace(bytes_of_block);
    const std::size_t most = std::min(of_thread * compressors.size(), own.end - own.begin);
    std::vector<std::byte> raw(most * bytes_of_block);
    std::vector<unsigned char> packed(most * room);
    EncodedPart part;
    part.sizes.resize(own.end - own.begin);
    part.bytes.reserve(part.sizes.size() * room);  // reserved only: pages are committed when written
    for (std::size_t batch = own.begin; batch < own.end; batch += most) {
        const std::size_t count = std::min(most, own.end - batch);
        parallel_for(0, static_cast<int>(count), [&](int i) {
            const auto at = static_cast<std::size_t>(i);
            const std::size_t first = (batch + at) * own.in_block, last = std::min(own.all, first + own.in_block),
                              mine = std::min(own.last, last);
            std::byte* block = raw.data() + at * bytes_of_block;
            array.numbers->copy(first, mine - first, block);
            if (mine < last) std::memcpy(block + (mine - first) * array.bytes_of_number, tail.data(), tail.size());
            part.sizes[batch - own.begin + at] =
                static_cast<std::uint32_t>(compressors[static_cast<std::size_t>(omp_get_thread_num())]->Compress(
                    reinterpret_cast<const unsigned char*>(block), (last - first) * array.bytes_of_number, packed.data() + at * room,
                    room));
        });
        for (std::size_t i = 0; i < count; ++i) {
            const std::uint32_t size = part.sizes[batch - own.begin + i];
            if (size == 0) throw OutputError("a frame could not be compressed");
            part.bytes.append(reinterpret_cast<const char*>(packed.data()) + i * room, size);
        }
    }
    return part;
}
#else
EncodedPart compressed_part(const DataArray&, Compression) {
    throw BadInput("this weir was built without VTK (WEIR_VTK=OFF) and compresses nothing");
}
#endif

}  // namespace

EncodedPart encoded_part(const DataArray& array, Compression compression) {
    if (compression != Compression::none) return compressed_part(array, compression);
    const OwnBlocks own(array);
    EncodedPart part;
    part.bytes.resize((own.last - own.first) * array.bytes_of_number);
    array.numbers->copy(own.first, own.last - own.first, reinterpret_cast<std::byte*>(part.bytes.data()));
    return part;
}

Extremes extremes_of(const DataArray& array) {
    constexpr std::size_t piece = 4096;  // number of tuples
    const int rank = communicator().rank();
    const std::size_t begin = array.tuples.begin(rank), end = array.tuples.end(rank);
    std::vector<Extremes> pieces((end - begin + piece - 1) / piece);
    parallel_for(0, static_cast<int>(pieces.size()), [&](int p) {
        const std::size_t from = begin + static_cast<std::size_t>(p) * piece;
        pieces[static_cast<std::size_t>(p)] = array.numbers->extremes(from, std::min(end, from + piece));
    });
    Extremes own, all;
    for (const Extremes& one : pieces) own.meet(one);
    if (array.tuples.all_on_first())
        all = own;
    else
        for (const Extremes& one : of_ranks(own)) all.meet(one);
    if (array.components > 1 && array.tuples.all() > 0) all.least = std::sqrt(all.least), all.most = std::sqrt(all.most);
    return all;
}

}  // namespace weir::output
