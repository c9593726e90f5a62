// Coverage of made-up ladders whose bands are known by hand: two grids to one with f = truth + C h have differences C h1 and 2 C h1, the
// observed order 1 and the width 1.5 C h1.
#include "validation/uncertainty/coverage.hpp"

#include "core/error.hpp"
#include "scene/scene.hpp"
#include "support/test.hpp"
#include "validation/uncertainty/coverage_scenes.hpp"
#include "validation/uncertainty/exact_series.hpp"

#include <cmath>

namespace coverage_tests {

using namespace weir;
using namespace weir::validation;

namespace {

/// Values on grids of width 4, 2, 1 (and 1/2 with four), of formal order 1.
KnownQuantity ladder(const std::vector<real>& values, real truth, real scale = 1) {
    KnownQuantity q{.scene = "made-up", .quantity = "f", .family = "mac", .kind = "end"};
    real h = 4;
    for (const real v : values) {
        q.grids.push_back(std::to_string(h));
        q.values.push_back({h, {v}});
        q.scales.push_back(scale);
        h /= 2;
    }
    q.truth = {truth};
    return q;
}

bool all(const CheckedBand&) { return true; }

}  // namespace

TEST("a band of first order is one and a half times the error of the finest grid") {
    const auto bands = check_bands({ladder({14, 12, 11}, 10)});
    ASSERT_EQ(bands.size(), 1u);
    EXPECT_NEAR(bands[0].error, 1, 1e-12);
    EXPECT_NEAR(bands[0].band.width, 1.5, 1e-9);
    EXPECT_NEAR(bands[0].ratio(), 1.5, 1e-9);
    EXPECT_TRUE(bands[0].covered);
}

TEST("every triple of neighbouring grids counts, each with the error of its own finest grid") {
    const auto bands = check_bands({ladder({14, 12, 11, 10.5}, 10)});
    ASSERT_EQ(bands.size(), 2u);
    EXPECT_EQ(bands[0].finest, 2u);
    EXPECT_NEAR(bands[0].error, 1, 1e-12);
    EXPECT_EQ(bands[1].finest, 3u);
    EXPECT_NEAR(bands[1].error, 0.5, 1e-12);
}

TEST("coverage is the share of bands at least as wide as the error, with the median of width over error") {
    // widths 1.5 with errors 1, 1.5, 2 and 3: two of four are covered
    const std::vector<KnownQuantity> quantities{ladder({14, 12, 11}, 10), ladder({14, 12, 11}, 9.5), ladder({14, 12, 11}, 9),
                                                ladder({14, 12, 11}, 8)};
    const Coverage coverage = coverage_of(check_bands(quantities), all);
    EXPECT_EQ(coverage.all, 4u);
    EXPECT_EQ(coverage.covered, 2u);
    EXPECT_NEAR(coverage.share(), 0.5, 1e-12);
    EXPECT_NEAR(coverage.median_ratio, 0.5 * (1 + 0.75), 1e-9);
    const Coverage first = coverage_of(check_bands(quantities), [](const CheckedBand& b) { return b.quantity == 0; });
    EXPECT_EQ(first.all, 1u);
    EXPECT_EQ(first.covered, 1u);
    EXPECT_TRUE(std::isnan(coverage_of({}, all).share()));
}

TEST("grids that do not differ cover only the truth itself, up to round-off") {
    const auto bands = check_bands({ladder({2, 2, 2}, 2), ladder({2, 2, 2}, 2 + 1e-13), ladder({2, 2, 2}, 2.001)});
    EXPECT_TRUE(bands[0].covered);
    EXPECT_TRUE(bands[1].covered);
    EXPECT_FALSE(bands[2].covered);
    EXPECT_TRUE(std::isinf(bands[0].ratio()));
}

TEST("the coarsest grid whose bound and those of all finer ones are within the wish is recommended") {
    // width 1.5 on the finest; bounds 4.5, 2.5, 1.5
    const KnownQuantity q = ladder({14, 12, 11}, 10, 100);
    EXPECT_EQ(grid_for(q, 0.05).grid, 0u);
    EXPECT_EQ(grid_for(q, 0.03).grid, 1u);
    EXPECT_EQ(grid_for(q, 0.02).grid, 2u);
    EXPECT_FALSE(grid_for(q, 0.01).grid.has_value());
    EXPECT_FALSE(grid_for(q, 0.05).wrong);
    EXPECT_NEAR(grid_for(q, 0.05).wish, 5, 1e-12);
}

TEST("a fourth grid is added only where three are not enough") {
    const KnownQuantity q = ladder({14, 12, 11, 10.5}, 10, 100);
    EXPECT_EQ(grid_for(q, 0.01).grid, 3u);  // width 0.75
    EXPECT_EQ(grid_for(q, 0.02).grid, 2u);  // of three grids; with four it would be the same
}

TEST("advice is wrong where the true error of the recommended grid is larger than the wish") {
    const std::vector<KnownQuantity> quantities{ladder({14, 12, 11}, 10, 100), ladder({14, 12, 11}, 8.5, 100)};
    const Advice advice = advice_for(quantities, 0.03);  // the second grid, whose errors are 2 and 3.5
    EXPECT_EQ(advice.answered, 2u);
    EXPECT_EQ(advice.wrong, 1u);
    EXPECT_NEAR(advice.wrong_share(), 0.5, 1e-12);
    const Advice refused = advice_for(quantities, 0.01);  // errors of the finest grid are 1 and 2.5
    EXPECT_EQ(refused.refused, 2u);
    EXPECT_EQ(refused.rightly_refused, 1u);
    EXPECT_TRUE(std::isnan(refused.wrong_share()));
}

TEST("extrapolation of values of first and of second order gives their limit; the order is at most the formal one") {
    EXPECT_NEAR(extrapolated({{4, {14}}, {2, {12}}, {1, {11}}}, 1).at(0), 10, 1e-9);
    EXPECT_NEAR(extrapolated({{4, {26}}, {2, {14}}, {1, {11}}}, 2).at(0), 10, 1e-9);
    EXPECT_NEAR(extrapolated({{4, {26}}, {2, {14}}, {1, {11}}}, 1).at(0), 8, 1e-9);
    EXPECT_THROW((void)extrapolated({{2, {12}}, {1, {11}}}, 1), BadInput);
}

TEST("mistakes in a file of scenes are reported with line and column") {
    const auto message = [](const std::string& text) -> std::string {
        try {
            (void)parse_coverage_scenes(text, "scenes.toml", ".");
        } catch (const scene::BadScene& wrong) {
            return wrong.what();
        }
        return "";
    };
    const std::string head = "[[scenes]]\nname = \"a\"\nscene = \"s.toml\"\n";
    EXPECT_NE(message(head + "grids = [8, 16]\nof = [{ quantity = \"x.max\" }]\n").find("scenes.toml:4:"), std::string::npos);
    EXPECT_NE(message(head + "grids = [8, 16, 12]\nof = [{ quantity = \"x.max\" }]\n").find("scenes.toml:4:"), std::string::npos);
    EXPECT_NE(message(head + "grids = [8, 12, 16]\nof = [{ quantity = \"x.max@2\" }]\n").find("scenes.toml:5:"), std::string::npos);
    EXPECT_NE(message(head + "grids = [8, 12, 16]\nfine = 3\nof = [{ quantity = \"x\" }]\n").find("scenes.toml:5:"), std::string::npos);
    EXPECT_EQ(message(head + "grids = [8, 12, 16]\nof = [{ quantity = \"x\" }]\n"), "");
}

TEST("an exact series has the name and the interval of the recorded one") {
    const RecordedSeries recorded{.name = "g.depth", .unit = "m", .curve = {.x = {0, 1, 2}, .y = {5, 5, 5}}};
    const RecordedSeries exact = series_from_formula(recorded, "2 + t");
    EXPECT_EQ(exact.name, "g.depth");
    EXPECT_NEAR(exact.curve.x.front(), 0, 1e-15);
    EXPECT_NEAR(exact.curve.x.back(), 2, 1e-15);
    EXPECT_NEAR(interpolate(exact.curve, 1.25), 3.25, 1e-12);
}

}  // namespace coverage_tests
