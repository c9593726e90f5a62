// Numbers that are kept beside published results, and what counts as moved.
#include "validation/report/pins.hpp"

#include <nlohmann/json.hpp>

#include <cmath>

#include "support/test.hpp"

namespace pins_tests {

using namespace weir;
using namespace weir::validation;

TEST("numbers are the same within 1e-6 of the larger, below 1e-9, and where both are none") {
    EXPECT_TRUE(same_number(1, 1 + 0.9e-6));
    EXPECT_FALSE(same_number(1, 1 + 1.2e-6));
    EXPECT_FALSE(same_number(-1, 1));
    EXPECT_TRUE(same_number(-9e-10, 9e-10));  // round-off
    EXPECT_FALSE(same_number(0, 2e-9));
    EXPECT_TRUE(same_number(std::nan(""), std::nan("")));
    EXPECT_FALSE(same_number(std::nan(""), 0));
    EXPECT_TRUE(same_number(infinity, infinity));
    EXPECT_FALSE(same_number(infinity, 1e300));
}

TEST("what is pinned is found again to nine digits, and what moved is named with both numbers") {
    const Numbers then = {{"flip at 64: volume.drift", 1.0 / 3}, {"steps", 128}, {"none", std::nan("")}};
    const auto pins = nlohmann::json::parse(pins_json(then, 2.4).dump());
    EXPECT_EQ(pins["numbers"]["flip at 64: volume.drift"].dump(), "0.333333333");
    const Comparison same = compare_numbers(then, pins);
    EXPECT_TRUE(same.moved.empty() && same.not_compared.empty());
    EXPECT_EQ(same.seconds_to_publish, 3);
    Numbers now = then;
    now["flip at 64: volume.drift"] *= 1.5, now["none"] = 7, now.erase("steps"), now["new"] = 1;
    EXPECT_EQ(
        compare_numbers(now, pins).moved,
        (std::vector<std::string>{"flip at 64: volume.drift changed by 50%: 0.333333333 published, 0.5 now", "new is not published: 1",
                                  "none changed: nan published, 7 now", "steps is published but no longer measured"}));
}

TEST("numbers of another processor, and those that are not there, are not compared, and that is said") {
    auto pins = pins_json({{"steps", 1}}, 1);
    pins["rounding"] = "an abacus";
    const Comparison c = compare_numbers({{"steps", 2}}, pins);
    EXPECT_TRUE(c.moved.empty());
    EXPECT_NE(comparison_text("tank", "weir validate tank", c)
                  .find("tank: not compared with the published results: their values were computed on an abacus"),
              std::string::npos);
    EXPECT_EQ(compare_numbers({{"steps", 2}}, nlohmann::json()).not_compared, "none are published");
    EXPECT_EQ(compare_numbers({{"steps", 2}}, nlohmann::json{{"numbers", 3}}).not_compared, "none are published");
}

}  // namespace pins_tests
