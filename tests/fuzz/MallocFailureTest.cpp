// MallocFailureTest.cpp - osgraytrace while the C library's malloc fails for good. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/apps/Program.h"

namespace
{

// While the loader runs the constructors of OSG's plugins, a failure ends the process in their
// code, because no exception passes the loader. The constructors are through after some 17,500
// allocations with the libraries of MPI.
constexpr long kPluginsLoaded = 18500;

} // namespace

TEST_CASE("stability 52: malloc that fails for good, for all libraries, ends in order",
          "[stability][fuzz]")
{
    constexpr int kPlaces = 16;
    for (const char* integrator : {"whitted", "path", "sppm", "photon-caustics"})
    {
        const TemporaryFolder folder;
        const std::string arguments = dataFile("cornell_box_glass.osgt") +
                                      " --size 48 48 --passes 2 --threads 2 -o box.exr "
                                      "--integrator " +
                                      integrator;
        const std::string preload = "env LD_PRELOAD='" OSGRAYTRACE_TEST_PRELOAD "' ";
        REQUIRE(osgraytrace(folder, arguments, preload + "OSGRAYTRACE_COUNT_TO=count").exitCode ==
                0);
        const long all = std::stol(contents(folder / "count"));
        REQUIRE(all > kPluginsLoaded + 2000);

        int refused = 0;
        for (int place = 0; place < kPlaces; ++place)
        {
            std::filesystem::remove(folder / "box.exr");
            const long from = kPluginsLoaded + (all - kPluginsLoaded) * place / kPlaces;
            const Outcome outcome = osgraytrace(
                folder, arguments, preload + "OSGRAYTRACE_FAIL_FROM=" + std::to_string(from));
            CAPTURE(integrator, from, outcome.exitCode, outcome.errors);
            const bool written = std::filesystem::exists(folder / "box.exr");
            CHECK((outcome.exitCode == 0 || outcome.exitCode == 2 || outcome.exitCode == 3 ||
                   outcome.exitCode == 4));
            CHECK(written == (outcome.exitCode == 0));
            if (outcome.exitCode != 0) CHECK_FALSE(outcome.errors.empty());
            refused += outcome.exitCode != 0;
        }
        CHECK(refused > kPlaces / 4);
    }
}
