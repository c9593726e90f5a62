// Tests named by sentences: TEST("what is true") { ... } and TEST_IN_2D_AND_3D("...") { uses D }. The suite is the name of
// the file that is compiled, also for bodies in a header that several such files share; where files are compiled together, that of the
// file.
#pragma once
#include <gtest/gtest.h>

#include <string>

#undef TEST

namespace weir::test {

class Sentence : public testing::Test {
public:
    explicit Sentence(void (*body)()) : body_(body) {}
    void TestBody() override { body_(); }

private:
    void (*body_)();
};

inline std::string file_stem(const std::string& path) {
    const auto slash = path.find_last_of('/');
    const auto name = slash == std::string::npos ? path : path.substr(slash + 1);
    return name.substr(0, name.find('.'));
}

inline int add(const char* file, int line, const std::string& sentence, void (*body)()) {
    testing::RegisterTest(file_stem(file).c_str(), sentence.c_str(), nullptr, nullptr, file, line,
                          [body]() -> testing::Test* { return new Sentence(body); });
    return 0;
}

}  // namespace weir::test

#ifdef WEIR_TESTS_JOINED
#define WEIR_TEST_FILE __FILE__
#else
#define WEIR_TEST_FILE __BASE_FILE__
#endif
#define WEIR_JOIN_(a, b) a##b
#define WEIR_JOIN(a, b) WEIR_JOIN_(a, b)

#define TEST(sentence)                                                                              \
    static void WEIR_JOIN(weir_test_body_, __LINE__)();                                             \
    [[maybe_unused]] static const int WEIR_JOIN(weir_test_entry_, __LINE__) =                       \
        weir::test::add(WEIR_TEST_FILE, __LINE__, sentence, &WEIR_JOIN(weir_test_body_, __LINE__)); \
    static void WEIR_JOIN(weir_test_body_, __LINE__)()

#define TEST_IN_2D_AND_3D(sentence)                                                                                               \
    template <int D>                                                                                                              \
    static void WEIR_JOIN(weir_test_body_, __LINE__)();                                                                           \
    [[maybe_unused]] static const int WEIR_JOIN(weir_test_entry_, __LINE__) =                                                     \
        weir::test::add(WEIR_TEST_FILE, __LINE__, std::string(sentence) + " [2D]", &WEIR_JOIN(weir_test_body_, __LINE__) < 2 >) + \
        weir::test::add(WEIR_TEST_FILE, __LINE__, std::string(sentence) + " [3D]", &WEIR_JOIN(weir_test_body_, __LINE__) < 3 >);  \
    template <int D>                                                                                                              \
    static void WEIR_JOIN(weir_test_body_, __LINE__)()
