// StatisticsFromEngineTest.cpp - what the public statistics say of the engine's progress.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/update/StatisticsFromEngine.h"
#include "tests/Catch.h"

using namespace osgRayTrace;
using namespace osgRayTrace::engine;
using Catch::Matchers::Contains;

TEST_CASE("statistics: the integrator is path once photons have ended, and a note says why",
          "[bridge]")
{
    RenderProgress progress;
    progress.integrator = IntegratorKind::PhotonCaustics;
    Statistics statistics;
    setImageStatistics(statistics, progress);
    CHECK(statistics.integrator == "photon-caustics");
    CHECK(statistics.photonNote == "");
    progress.photonNote = PhotonNote::Ended;
    setImageStatistics(statistics, progress);
    CHECK(statistics.integrator == "path");
    CHECK_THAT(statistics.photonNote, Contains("photons have ended"));
}
