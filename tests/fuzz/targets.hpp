// The kinds of file that users hand in, and what reads any bytes as each: the fuzzers, one a kind, and the test that replays what they
// start from and what they found (tests/input/fuzz_findings.cpp).
#pragma once
#include <array>
#include <string_view>

namespace weir::fuzz {

/// True: such a file; false: refused with a message, as BadInput (or, by a run, as a numerical failure). Every other exception passes, and
/// the program is aborted where what was accepted contradicts itself.
bool made_up(std::string_view bytes);          // a scene of made-up solvers: the reader alone
bool scene(std::string_view bytes);            // a scene of the real ones
bool run(std::string_view bytes);              // the same, and where it is small, two steps of it
bool session(std::string_view bytes);          // what a session in a window keeps, and repeats
bool checkpoint(std::string_view bytes);       // blocks, to which the right checksum is added
bool mesh(std::string_view bytes);             // the first byte: STL, OBJ or PLY
bool raster(std::string_view bytes);           // the first byte: ESRI ASCII grid or PGM
bool image(std::string_view bytes);            // a PNG
bool frame(std::string_view bytes);            // VTK's .vti, .vtp and .pvd, and run.json
bool rows(std::string_view bytes);             // tables: steps.csv and probes of a run that goes on, data of a case
bool validation_case(std::string_view bytes);  // case.toml
bool cost(std::string_view bytes);             // cost.toml
bool stability(std::string_view bytes);        // stability.toml

struct Kind {
    const char* name;
    bool (*read)(std::string_view);
};
inline constexpr std::array kinds{Kind{"made_up", made_up},
                                  Kind{"scene", scene},
                                  Kind{"run", run},
                                  Kind{"session", session},
                                  Kind{"checkpoint", checkpoint},
                                  Kind{"mesh", mesh},
                                  Kind{"raster", raster},
                                  Kind{"rows", rows},
                                  Kind{"validation_case", validation_case},
                                  Kind{"cost", cost},
#ifdef WEIR_HAS_VTK
                                  Kind{"image", image},
                                  Kind{"frame", frame},
#endif
                                  Kind{"stability", stability}};

}  // namespace weir::fuzz
