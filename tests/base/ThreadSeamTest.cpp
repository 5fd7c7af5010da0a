// ThreadSeamTest.cpp - a second thread in what is not thread safe ends the program.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/base/ThreadSeam.h"

#include "tests/Catch.h"
#include "tests/ChildProcess.h"

using osgRayTrace::test::isAborted;
using Seam = osgRayTrace::engine::BasicThreadSeam<true>;

namespace
{

/// Enters a seam twice: at once by two threads, or one after the other.
void enterTwice(bool atOnce)
{
    Seam seam;
    const auto enter = [&] { const Seam::Entry entry(seam); };
    {
        const Seam::Entry first(seam);
        if (atOnce) std::thread(enter).join();
    }
    std::thread(enter).join();
}

} // namespace

TEST_CASE("a seam lets threads in one after the other", "[base]")
{
    CHECK_FALSE(isAborted([] { enterTwice(false); }));
}

TEST_CASE("a seam aborts when a second thread enters", "[base]")
{
    CHECK(isAborted([] { enterTwice(true); }));
}

TEST_CASE("a thread may enter its seam again", "[base]")
{
    Seam seam;
    const Seam::Entry outer(seam);
    {
        const Seam::Entry inner(seam);
    }
    const Seam::Entry again(seam);
    SUCCEED();
}
