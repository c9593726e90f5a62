// Runs the tests of a program. One that was skipped is told with its reason, and ends the program with 77, which is how ctest knows of it:
// an entry of which a test was skipped is no entry that passed. A filter that selects no test is a failure: ctest would call it a pass.
#include <gtest/gtest.h>

#include <iostream>
#include <set>
#include <string>

namespace {

class Skips : public testing::EmptyTestEventListener {
public:
    void OnTestPartResult(const testing::TestPartResult& result) override {
        if (result.skipped()) reasons.insert(result.message());
    }
    std::set<std::string> reasons;
};

}  // namespace

int main(int argc, char** argv) {
    testing::InitGoogleTest(&argc, argv);
    auto* skips = new Skips;  // the list of listeners owns it
    testing::UnitTest::GetInstance()->listeners().Append(skips);
    const int failed = RUN_ALL_TESTS();
    if (failed || testing::GTEST_FLAG(list_tests)) return failed;
    if (testing::UnitTest::GetInstance()->test_to_run_count() == 0) {
        std::cout << "no test is selected by --gtest_filter=" << testing::GTEST_FLAG(filter) << '\n';
        return 1;
    }
    if (skips->reasons.empty()) return 0;
    for (std::string reason : skips->reasons) {
        while (!reason.empty() && reason.back() == '\n') reason.pop_back();
        std::cout << "skipped: " << reason << " (" << testing::UnitTest::GetInstance()->skipped_test_count() << " of "
                  << testing::UnitTest::GetInstance()->test_to_run_count() << " tests)\n";
    }
    return 77;
}
