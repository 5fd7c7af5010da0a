// MemoryLimitTest.cpp - osgraytrace in an address space of 1 GiB. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/apps/Program.h"

namespace
{

constexpr const char* kLimit = "ulimit -v 1048576 &&";
const std::string kBox = dataFile("cornell_box.osgt");

} // namespace

TEST_CASE("stability 52: within 1 GiB of address space a picture of usual size is rendered",
          "[stability][fuzz]")
{
    const TemporaryFolder folder;
    const Outcome outcome =
        osgraytrace(folder, kBox + " -o box.exr --size 256 256 --passes 2 --threads 2", kLimit);
    CAPTURE(outcome.errors);
    CHECK(outcome.exitCode == 0);
    CHECK(folder.fileNames() == std::vector<std::string>{"box.exr"});
}

TEST_CASE(
    "stability 52: what does not fit into 1 GiB is refused with a message, and leaves no file",
    "[stability][fuzz]")
{
    // At the largest sizes the film does not fit into memory; at others the film fits, but not the
    // pictures made of it.
    for (const char* size : {"16384 16384", "8192 8192", "6000 6000", "5000 5000", "4000 4000"})
    {
        CAPTURE(size);
        const TemporaryFolder folder;
        const Outcome outcome = osgraytrace(
            folder, kBox + " -o box.exr --integrator whitted --passes 1 --threads 2 --size " + size,
            kLimit);
        CAPTURE(outcome.exitCode, outcome.errors);
        if (outcome.exitCode == 0) continue;
        CHECK((outcome.exitCode == 3 || outcome.exitCode == 4)); // cannot render, cannot write
        CHECK(outcome.errors.find("osgraytrace: ") !=
              std::string::npos); // follows warnings of the library
        CHECK(outcome.errors.find("memory") != std::string::npos);
        CHECK(folder.fileNames().empty());
    }
    const TemporaryFolder folder;
    CHECK(
        osgraytrace(folder, kBox + " -o box.exr --passes 1 --size 16384 16384", kLimit).exitCode ==
        3);
}
