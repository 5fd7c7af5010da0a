// DisplayTextureTest.cpp - a picture that is copied to OpenGL in parts looks like one that is
// copied as a whole. Layer: tests.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/DisplayTexture.h"
#include "osgRayTrace/film/Film.h"
#include "osgRayTrace/film/TileOrder.h"
#include "tests/Catch.h"

#include <osgRayTrace/offscreen/OffscreenContext>

#include <osg/Depth>
#include <osg/GraphicsContext>
#include <osg/State>
#include <osg/Viewport>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <random>
#include <vector>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;

namespace
{

constexpr int kWidth = 150, kHeight = 90; // tiles at the right and at the top are cut
constexpr int kTiles = 10 * 6;

struct Seen
{
    std::vector<uint8_t> rgba = std::vector<uint8_t>(4 * kWidth * kHeight);
    std::vector<float> depth = std::vector<float>(kWidth * kHeight);
};

/// An OpenGL context in which displays are drawn, one at a time.
struct Window
{
    explicit Window(osg::ref_ptr<osg::GraphicsContext> made, int width = kWidth,
                    int height = kHeight)
        : context(made), viewport(new osg::Viewport(0, 0, width, height))
    {
        REQUIRE(context->realize());
        REQUIRE(context->makeCurrent());
        renderInfo.setState(context->getState());
        depth->setFunction(osg::Depth::ALWAYS);
        state().initializeExtensionProcs();
        state().reset();
        state().apply(stateSet.get());
        state().applyAttribute(viewport.get());
        state().applyMode(GL_DEPTH_TEST, true);
        state().applyAttribute(depth.get());
    }
    ~Window()
    {
        context->releaseContext();
        context->close();
    }

    osg::State& state() { return *context->getState(); }

    Seen draw(DisplayTexture& display)
    {
        Seen seen;
        glViewport(0, 0, static_cast<int>(viewport->width()), static_cast<int>(viewport->height()));
        glClearColor(0.0f, 0.0f, 0.0f, 0.0f);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        REQUIRE(display.draw(renderInfo, DepthMap{1.0f, 0.0f, 1.0f}));
        glPixelStorei(GL_PACK_ALIGNMENT, 1);
        glReadPixels(0, 0, kWidth, kHeight, GL_RGBA, GL_UNSIGNED_BYTE, seen.rgba.data());
        glReadPixels(0, 0, kWidth, kHeight, GL_DEPTH_COMPONENT, GL_FLOAT, seen.depth.data());
        REQUIRE(glGetError() == GL_NO_ERROR);
        GLint rowLength = -1;
        glGetIntegerv(GL_UNPACK_ROW_LENGTH, &rowLength);
        REQUIRE(rowLength == 0); // other code that copies to OpenGL finds the default
        return seen;
    }

    osg::ref_ptr<osg::GraphicsContext> context;
    osg::ref_ptr<osg::Viewport> viewport;
    osg::ref_ptr<osg::Depth> depth = new osg::Depth;
    osg::ref_ptr<osg::StateSet> stateSet = DisplayTexture::createStateSet();
    osg::RenderInfo renderInfo;
};

/// Two displays that get the same pictures: one is told of changed parts, the other copies
/// everything each time.
struct Pair
{
    std::mt19937 random{3};
    DisplayTexture parts, whole;

    DisplayTexture* both[2] = {&parts, &whole};

    void writePixel(std::size_t pixel, bool color, bool depth)
    {
        const uint32_t rgb = static_cast<uint32_t>(random());
        const float z = static_cast<float>(random() % 1000) / 1000.0f;
        for (DisplayTexture* display : both)
        {
            for (std::size_t c = 0; color && c < 4; ++c)
                display->rgba()[4 * pixel + c] =
                    c == 3 ? uint8_t(255) : static_cast<uint8_t>(rgb >> 8 * c);
            if (depth) display->depth()[pixel] = z;
        }
    }

    /// Replaces the whole picture by one of the given size.
    void replace(int width, int height, bool full)
    {
        for (DisplayTexture* display : both)
            display->resize(width, height, full);
        for (std::size_t p = 0; p < std::size_t(width * height); ++p)
            writePixel(p, true, true);
        for (DisplayTexture* display : both)
            display->modified();
    }

    /// Changes some tiles of a picture that has the view's size: always their colours, and in a
    /// third of the calls their depths, too.
    void change(unsigned percent)
    {
        ChangedTiles tiles;
        tiles.reset(kWidth, kHeight);
        const bool depths = random() % 3 == 0;
        for (int tile = 0; tile < kTiles; ++tile)
        {
            if (random() % 100 >= percent) continue;
            tiles.color[std::size_t(tile)] = 1;
            tiles.depth[std::size_t(tile)] = depths;
            const int left = tile % 10 * kTileSize, bottom = tile / 10 * kTileSize;
            for (int y = bottom; y < std::min(bottom + kTileSize, kHeight); ++y)
                for (int x = left; x < std::min(left + kTileSize, kWidth); ++x)
                    writePixel(std::size_t(y * kWidth + x), true, depths);
        }
        parts.modified(tiles);
        whole.modified();
    }
};

void checkSame(Window& window, Pair& pair)
{
    const Seen parts = window.draw(pair.parts), whole = window.draw(pair.whole);
    CHECK(parts.rgba == whole.rgba);
    CHECK(parts.depth == whole.depth);
    if (pair.whole.width() < kWidth) return;
    const uint8_t* written = pair.whole.rgba();
    CHECK(std::equal(whole.rgba.begin(), whole.rgba.end(), written)); // something is drawn
}

} // namespace

TEST_CASE("display: a picture copied in parts is the whole one, whatever happens to it", "[gl]")
{
    for (const auto create : {createOSMesaContext, createEGLContext})
    {
        Window window(create(kWidth, kHeight, nullptr));
        Pair pair;
        bool full = false;
        for (int step = 0; step < 150; ++step)
        {
            CAPTURE(step);
            const unsigned what = pair.random() % 12;
            if (!full || what == 0)
            {
                full = pair.random() % 4 != 0;
                const int divider = full ? 1 : 2 + int(pair.random() % 3);
                pair.replace(kWidth / divider, kHeight / divider, full);
            }
            else if (what == 1) // as if the context were lost
            {
                for (DisplayTexture* display : pair.both)
                    display->releaseGLObjects(pair.random() % 2 ? &window.state() : nullptr);
            }
            else
            {
                pair.change(what < 8 ? 10 : what < 10 ? 60 : 100);
            }
            if (pair.random() % 4 != 0) checkSame(window, pair); // otherwise the frame is not drawn
        }
        checkSame(window, pair);
        for (DisplayTexture* display : pair.both)
            display->releaseGLObjects(&window.state());
    }
}

TEST_CASE("display: marks of a picture of another size have all of it copied", "[gl]")
{
    Window window(createOSMesaContext(kWidth, kHeight));
    Pair pair;
    pair.replace(kWidth, kHeight, true);
    checkSame(window, pair);
    for (std::size_t p = 0; p < std::size_t(kWidth * kHeight); ++p)
        pair.writePixel(p, true, true);
    ChangedTiles other;
    other.reset(kWidth - 1, kHeight);
    pair.parts.modified(other);
    pair.whole.modified();
    checkSame(window, pair);
    for (DisplayTexture* display : pair.both)
        display->releaseGLObjects(&window.state());
}

TEST_CASE("display: memory for pictures of full size is there once, and changes nothing", "[gl]")
{
    DisplayTexture display;
    display.resize(8, 4, false);
    const uint8_t* small = display.rgba();
    display.reserve(32, 16);
    CHECK((display.width() == 8 && display.height() == 4));
    CHECK(display.rgba() == small);

    display.resize(32, 16, true);
    uint8_t* large = display.rgba();
    CHECK(std::count(large, large + 4 * 32 * 16, 0) == 4 * 32 * 16);
    large[5] = 77;
    display.reserve(64, 64); // as for a window that grew: resize() makes room
    CHECK((display.width() == 32 && display.height() == 16));
    CHECK(display.rgba() == large);
    CHECK(display.rgba()[5] == 77);
}

TEST_CASE("display: prints what copies and drawing take at 1920 x 1080", "[.copy-times]")
{
    constexpr int kWide = 1920, kHigh = 1080, kTimes = 15;
    Window window(createOSMesaContext(kWide, kHigh), kWide, kHigh);
    DisplayTexture display;
    display.resize(kWide, kHigh, true);
    std::fill_n(display.rgba(), 4 * kWide * kHigh, uint8_t(200));
    std::fill_n(display.depth(), kWide * kHigh, 0.5f);
    display.modified();
    const TileOrder order(120, 68, 4);
    const auto print = [&](const char* what, double share, bool depth)
    {
        std::vector<double> copies, finishes;
        for (int i = 0; i < kTimes; ++i)
        {
            ChangedTiles tiles;
            tiles.reset(kWide, kHigh);
            for (std::size_t place = 0; place < share * order.places(); ++place)
            {
                const std::size_t tile = (order.tile(place) + std::size_t(i)) % tiles.color.size();
                tiles.color[tile] = 1;
                tiles.depth[tile] = depth;
            }
            display.modified(tiles);
            glFinish();
            const auto begin = std::chrono::steady_clock::now();
            display.draw(window.renderInfo, DepthMap{1.0f, 0.0f, 1.0f});
            const auto drawn = std::chrono::steady_clock::now();
            glFinish();
            const auto end = std::chrono::steady_clock::now();
            copies.push_back(std::chrono::duration<double, std::milli>(drawn - begin).count());
            finishes.push_back(std::chrono::duration<double, std::milli>(end - drawn).count());
        }
        std::sort(copies.begin(), copies.end());
        std::sort(finishes.begin(), finishes.end());
        std::printf("%s: %.2f ms, then drawn in %.2f ms\n", what, copies[kTimes / 2],
                    finishes[kTimes / 2]);
    };
    print("nothing copied", 0.0, false);
    print("all", 1.0, true);
    print("all colours", 1.0, false);
    print("a quarter, with depths", 0.25, true);
    print("a quarter, colours", 0.25, false);
    print("a tenth, with depths", 0.1, true);
    display.releaseGLObjects(&window.state());
}
