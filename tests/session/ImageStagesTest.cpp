// ImageStagesTest.cpp - upsampling follows edges as far as there is time.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"
#include "tests/session/CentredPass.h"

#include "osgRayTrace/session/upsample/Upsample.h"
#include "osgRayTrace/session/view/ImageStages.h"

#include <vector>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr int kWidth = 340, kHeight = 250, kDivider = 2;
constexpr double kPixels = double(kWidth) * kHeight;

enum class Traced
{
    Nothing,
    Edges,  ///< pixels on edges
    Around, ///< pixels on edges and beside them
    All,
};

/// Holds a reduced image, and stages whose clock says that upsampling took a given time.
struct Enlarged
{
    Enlarged()
    {
        View view =
            perspectiveView({278, 278, 20}, {278, 250, 559}, {0, 1, 0}, 50.0, kWidth, kHeight);
        view.width /= kDivider;
        view.height /= kDivider;
        renderCentredPass(session, cornellBox().build(), view);
        linear = expected(0.0);
        all = expected(kAllTraced);
        around = expected(1.0);
        REQUIRE(counts.around > 0.06); // enough to learn the cost from
        REQUIRE(counts.around < 0.25);
        REQUIRE(counts.edges < 0.9 * counts.around);
        edges = expected(counts.edges);
        stages.reset(workers);
    }

    /// Returns which pixels are traced if upsampling may take this many seconds.
    Traced traced(double seconds)
    {
        std::vector<uint8_t> rgba(4 * std::size_t(kPixels));
        looks = 0;
        stages.presentUpsampled(session, kWidth, kHeight, {{}, rgba.data()}, seconds);
        if (rgba == all) return Traced::All;
        if (rgba == around) return Traced::Around;
        if (rgba == edges) return Traced::Edges;
        REQUIRE((rgba == linear));
        return Traced::Nothing;
    }

    /// Presents this many pictures in which nothing is visible.
    void showBlank(int pictures)
    {
        View view = perspectiveView({278, 278, -900}, {278, 250, -2000}, {0, 1, 0}, 50.0, 8, 8);
        RenderSession blank(workers);
        renderCentredPass(blank, cornellBox().build(), view);
        std::vector<uint8_t> rgba(4 * 16 * 16);
        for (int i = 0; i < pictures; ++i)
        {
            looks = 0;
            stages.presentUpsampled(blank, 16, 16, {{}, rgba.data()}, 1.0);
        }
    }

    std::vector<uint8_t> expected(double mostTraced)
    {
        std::vector<uint8_t> rgba(4 * std::size_t(kPixels));
        counts = session.presentUpsampled(session.resolvedImage(), session.surfaceSamples(), kWidth,
                                          kHeight, {{}, rgba.data()}, mostTraced);
        return rgba;
    }

    double foreseen() const { return stages.upsampleSeconds(kWidth, kHeight); }

    std::shared_ptr<Workers> workers = std::make_shared<Workers>(1);
    RenderSession session{workers};
    UpsampleCounts counts;
    std::vector<uint8_t> linear, edges, around, all;
    double taken = 0.0; ///< by each image [s]
    int looks = 0;
    ImageStages stages{[this] { return taken * looks++; }};
};

} // namespace

TEST_CASE("image stages: as many pixels are traced as there is time for", "[session]")
{
    // Whatever is traced, it takes 40 ms, and is learnt as the cost of all pixels.
    Enlarged enlarged;
    enlarged.taken = 0.040;
    for (int i = 0; i < 20; ++i)
        REQUIRE(enlarged.traced(10.0) == Traced::All);
    CHECK(enlarged.foreseen() == Approx(0.6 * 0.040).epsilon(0.01)); // edges alone would be less
    CHECK(enlarged.traced(0.041) == Traced::All);
    CHECK(enlarged.traced(0.037) == Traced::All); // all pixels are kept for as long as possible
    CHECK(enlarged.traced(0.035) == Traced::Around);
    enlarged.taken = 0.008;
    CHECK(enlarged.traced(0.035) == Traced::Around);

    // Without edges an image takes 1 ms. The expected cost of edges is kept, so that fewer pixels
    // are chosen.
    enlarged.taken = 0.001;
    CHECK(enlarged.traced(0.002) == Traced::Nothing);
    CHECK(enlarged.traced(0.002) == Traced::Nothing);
    CHECK(enlarged.foreseen() > 0.003);

    // The expected cost is forgotten after a while, and edges are tried again.
    int frames = 0;
    while (frames < 1000 && enlarged.traced(0.002) == Traced::Nothing)
        ++frames;
    CHECK(frames > 50);
    CHECK(frames < 500);
}

TEST_CASE("image stages: the first picture along edges takes no more than it may", "[session]")
{
    // The cost of edges is unknown, as after views without edges.
    Enlarged enlarged;
    enlarged.taken = 0.001;
    CHECK(enlarged.traced(0.00105) == Traced::Nothing);
    CHECK(enlarged.traced(0.00110) == Traced::Edges);
    CHECK(enlarged.traced(0.00250) == Traced::Around);
    CHECK(enlarged.traced(0.020) == Traced::All);
}

TEST_CASE("image stages: images without edges do not make edges cheap", "[session]")
{
    Enlarged enlarged;
    enlarged.taken = 0.040;
    for (int i = 0; i < 20; ++i)
        REQUIRE(enlarged.traced(10.0) == Traced::All);
    enlarged.taken = 3e-6;
    enlarged.showBlank(2000);
    enlarged.taken = 0.001;
    CHECK(enlarged.foreseen() < 0.002);                 // the time of a picture without edges
    CHECK(enlarged.traced(0.00105) == Traced::Nothing); // as if the cost were unknown
}
