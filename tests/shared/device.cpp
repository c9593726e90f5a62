// The device seam by itself: names, plans of memory, launches, the compiler's words.
#include "shared/device.hpp"

#include "core/error.hpp"
#include "particles/opencl/device_memory.hpp"

#include "support/test.hpp"

#include <numeric>
#include <vector>

using namespace weir;
using namespace weir::backend;

namespace {

/// The text of the BadInput that f throws.
template <class F>
std::string refusal(F&& f) {
    try {
        f();
    } catch (const BadInput& refused) {
        return refused.what();
    }
    ADD_FAILURE() << "was not refused";
    return "";
}

bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST("a backend is known by name, with an instruction set or a device's number behind it") {
    EXPECT_EQ(parse_choice("threads").isa, "auto");
    EXPECT_EQ(parse_choice("threads:avx2").isa, "avx2");
    EXPECT_EQ(static_cast<int>(parse_choice("opencl").kind), static_cast<int>(Choice::Kind::opencl));
    EXPECT_EQ(parse_choice("opencl:3").device, 3);
    EXPECT_EQ(static_cast<int>(parse_choice("reference").kind), static_cast<int>(Choice::Kind::reference));
    for (const char* wrong : {"", "cuda", "threads:neon", "opencl:", "opencl:x", "opencl:-1", "opencl:1x", "opencl ", "reference:1"})
        EXPECT_TRUE(says(refusal([&] { parse_choice(wrong); }), "known: threads")) << wrong;
}

TEST("a device that is not there is refused, and the message says how to get one") {
    const auto count = devices().size();
    const std::string text = refusal([&] { open_device(static_cast<int>(count)); });
    EXPECT_TRUE(says(text, "weir list devices") || says(text, "WEIR_OPENCL")) << text;
}

TEST("more particles than a device has memory for are refused with the number that would fit") {
    particles::DevicePlan plan;
    Memory few, many;
    plan.want(few, 20), plan.want(many, 80);
    EXPECT_EQ(plan.bytes_per_particle(), 100u);
    DeviceInfo small;
    small.memory = 1000000, small.largest = 1000000;
    plan.check(small, 9000);  // of 90 per cent of the memory
    EXPECT_TRUE(says(refusal([&] { plan.check(small, 9001); }), "9000 particles would"));
    small.largest = 240000;  // 80 bytes of each particle in one piece
    EXPECT_TRUE(says(refusal([&] { plan.check(small, 8000); }), "3000 particles would"));
}

TEST("a kernel gets its arguments and runs behind those launched before; its time is counted") {
    if (const std::string why = test::missing_device(); !why.empty()) GTEST_SKIP() << why;
    const auto device = open_device(0);
    device->compile("__kernel void twice(int n, __global int* x) { int i = get_global_id(0); if (i < n) x[i] = 2 * x[i]; }",
                    "-cl-std=CL1.2");
    std::vector<int> numbers(1000), back(1000);
    std::iota(numbers.begin(), numbers.end(), 0);
    {
        const Memory memory = device->alloc(4000);
        EXPECT_EQ(device->allocated(), 4000u);
        device->upload(memory, numbers.data(), 4000);
        for (int k = 0; k < 3; ++k) device->launch("twice", 999, 64, {999, memory});
        device->download(back.data(), memory, 4000);
    }
    for (int i = 0; i < 1000; ++i) EXPECT_EQ(back[static_cast<std::size_t>(i)], (i < 999 ? 8 : 1) * i);
    ASSERT_EQ(device->timings().size(), 1u);
    EXPECT_EQ(device->timings().front().calls, 0);  // taken by the line before
    EXPECT_EQ(device->allocated(), 0u);
}

TEST("what the driver's compiler says about a kernel is passed on") {
    if (const std::string why = test::missing_device(); !why.empty()) GTEST_SKIP() << why;
    EXPECT_TRUE(says(refusal([&] { open_device(0)->compile("__kernel void f() { nonsense; }", ""); }), "nonsense"));
}
