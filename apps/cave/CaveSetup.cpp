// CaveSetup.cpp - reads windows, channels and screens of a configuration. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/cave/CaveSetup.h"

#include "apps/common/Failure.h"

#include <osg/Math>

#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <map>

namespace osgRayTrace::app
{

namespace
{

constexpr int kMostPixels = 32768;
constexpr int kMost = 256;                             // windows, channels, screens
constexpr int64_t kMostTotalPixels = int64_t(1) << 28; // of all windows, of all walls

/// Returns the number of elements that are numbered from 0 on without a gap.
int countOf(const CaveFile& file, const std::string& path, const std::string& cap)
{
    const int most = file.integer(cap, "value", 100, 0, 100000);
    int count = 0;
    while (count < most && file.find(path + ":" + std::to_string(count), "name"))
        if (++count > kMost)
            throw Failure(kCannotLoad, file.name() + ": there are more than " +
                                           std::to_string(kMost) + " of " + path);
    return count;
}

/// Checks the pixels of all parts together. T: a type with a width and a height.
template <class T>
void checkTotal(const std::string& file, const std::vector<T>& parts, const char* what)
{
    int64_t pixels = 0;
    for (const T& part : parts)
        pixels += int64_t(part.width) * part.height;
    if (pixels <= kMostTotalPixels) return;
    throw Failure(kCannotLoad, file + ": all " + what + " together have " + std::to_string(pixels) +
                                   " pixels, more than " + std::to_string(kMostTotalPixels));
}

CavePose poseOf(const CaveFile& file, const std::string& path, const char* x, const char* y,
                const char* z)
{
    CavePose pose;
    pose.position = {file.number(path, x, 0.0), file.number(path, y, 0.0),
                     file.number(path, z, 0.0)};
    pose.h = file.number(path, "h", 0.0);
    pose.p = file.number(path, "p", 0.0);
    pose.r = file.number(path, "r", 0.0);
    return pose;
}

CaveWindow windowOf(const CaveFile& file, int index)
{
    const std::string path = "WindowConfig.Window:" + std::to_string(index);
    CaveWindow window;
    window.width = file.integer(path, "width", 600, 1, kMostPixels);
    window.height = file.integer(path, "height", 400, 1, kMostPixels);
    window.left = file.integer(path, "left", 0, -kMostPixels, kMostPixels);
    window.bottom = file.integer(path, "bottom", 0, -kMostPixels, kMostPixels);
    window.decoration = file.flag(path, "decoration", false);
    window.quadBuffer = file.flag(path, "quadBuffer", false);
    const std::string pipe = file.text(path, "pipeIndex", "0");
    if (pipe == "display") return window;
    const std::string pipePath = "PipeConfig.Pipe:" + pipe;
    window.displayServer = file.integer(pipePath, "server", 0, 0, 1000);
    window.displayScreen = file.integer(pipePath, "screen", 0, 0, 1000);
    return window;
}

struct Mode
{
    CaveStereo stereo = CaveStereo::None;
    CaveEye eye = CaveEye::Centre;
    bool followsHead = false, fixedViewer = false;
};

Mode modeOf(const CaveFile& file, const std::string& path)
{
    static const std::map<std::string, Mode> modes = {
        {"MONO", {}},
        {"LEFT", {CaveStereo::None, CaveEye::Left}},
        {"RIGHT", {CaveStereo::None, CaveEye::Right}},
        {"HORIZONTAL_SPLIT", {CaveStereo::LeftRight}},
        {"VERTICAL_SPLIT", {CaveStereo::TopBottom}},
        {"QUAD_BUFFER", {CaveStereo::QuadBuffer}},
        {"ANAGLYPHIC", {CaveStereo::Anaglyph}},
        {"FIXED_VIEWER", {CaveStereo::None, CaveEye::Centre, false, true}},
        {"HMD", {CaveStereo::None, CaveEye::Centre, true, false}},
    };
    const auto value = file.find(path, "stereoMode");
    const auto found = modes.find(value ? value->text : "MONO");
    if (found != modes.end()) return found->second;
    throw Failure(kCannotLoad,
                  value->element->file + ":" + std::to_string(value->element->line) +
                      ": <Channel>: stereoMode=\"" + value->text +
                      "\" is not supported; MONO, LEFT, RIGHT, HORIZONTAL_SPLIT, "
                      "VERTICAL_SPLIT, QUAD_BUFFER, ANAGLYPHIC, FIXED_VIEWER and HMD are");
}

CaveWall wallOf(const CaveFile& file, int screen, int channels, int windows)
{
    const std::string screenPath = "ScreenConfig.Screen:" + std::to_string(screen);
    CaveWall wall;
    wall.index = screen;
    wall.screenWidth = file.number(screenPath, "width", 600.0);
    wall.screenHeight = file.number(screenPath, "height", 400.0);
    if (!(wall.screenWidth > 0.0 && wall.screenHeight > 0.0))
        throw Failure(kCannotLoad,
                      file.name() + ": screen " + std::to_string(screen) + " has no area");
    wall.screen = poseOf(file, screenPath, "originX", "originY", "originZ");

    const int channel = file.integer(screenPath, "channelIndex", screen, 0, 100000);
    if (channel >= channels)
        throw Failure(kCannotLoad, file.name() + ": screen " + std::to_string(screen) +
                                       " is on channel " + std::to_string(channel) +
                                       ", which does not exist");
    const std::string path = "ChannelConfig.Channel:" + std::to_string(channel);
    wall.width = file.integer(path, "width", 600, 1, kMostPixels);
    wall.height = file.integer(path, "height", 400, 1, kMostPixels);
    wall.left = file.integer(path, "left", 0, -kMostPixels, kMostPixels);
    wall.bottom = file.integer(path, "bottom", 0, -kMostPixels, kMostPixels);
    wall.window = file.integer(path, "windowIndex", 0, 0, 100000);
    if (wall.window >= windows)
        throw Failure(kCannotLoad, file.name() + ": channel " + std::to_string(channel) +
                                       " is in window " + std::to_string(wall.window) +
                                       ", which does not exist");
    const Mode mode = modeOf(file, path);
    wall.stereo = mode.stereo;
    wall.eye = mode.eye;
    wall.followsHead = mode.followsHead;
    wall.fixedViewer = mode.fixedViewer;
    wall.swapsEyes = file.flag(path, "swapStereoEyes", false);
    const std::string eye = file.text(path, "eye", ""); // ours: CalVR shows HMDs the middle eye
    if (eye == "LEFT") wall.eye = CaveEye::Left;
    if (eye == "RIGHT") wall.eye = CaveEye::Right;
    wall.viewer = poseOf(file, path + ".ViewerPosition", "x", "y", "z").position;
    return wall;
}

int required(const CaveFile& file, const std::string& path, const std::string& cap)
{
    const int count = countOf(file, path, cap);
    if (count > 0) return count;
    throw Failure(kCannotLoad, file.name() + ": there is no " + path +
                                   " with name=\"0\" for host " + caveHost());
}

} // namespace

osg::Matrixd CavePose::matrix() const
{
    return osg::Matrixd::rotate(osg::DegreesToRadians(r), osg::Vec3d(0, 1, 0)) *
           osg::Matrixd::rotate(osg::DegreesToRadians(p), osg::Vec3d(1, 0, 0)) *
           osg::Matrixd::rotate(osg::DegreesToRadians(h), osg::Vec3d(0, 0, 1)) *
           osg::Matrixd::translate(position);
}

CaveSetup caveSetup(const CaveFile& file)
{
    CaveSetup setup;
    const int windows = required(file, "WindowConfig.Window", "NumWindows");
    const int channels = required(file, "ChannelConfig.Channel", "NumChannels");
    const int screens = required(file, "ScreenConfig.Screen", "NumScreens");
    for (int i = 0; i < windows; ++i)
        setup.windows.push_back(windowOf(file, i));
    for (int i = 0; i < screens; ++i)
        setup.walls.push_back(wallOf(file, i, channels, windows));
    checkTotal(file.name(), setup.windows, "windows");
    checkTotal(file.name(), setup.walls, "channels");
    setup.head = poseOf(file, "ViewerPosition", "x", "y", "z");
    setup.separation = file.number("Stereo", "separation", 64.0);
    if (!file.flag("EyeSeparation", "value", true)) setup.separation = 0.0;
    setup.omniStereo = file.flag("Stereo", "omniStereo", false);
    setup.nearPlane = file.number("Near", "value", 10.0);
    setup.farPlane = file.number("Far", "value", 1e7);
    if (!(setup.nearPlane > 0.0 && setup.farPlane > setup.nearPlane))
        throw Failure(kCannotLoad, file.name() + ": Near and Far are no depth range");
    for (int i = 0; i < 3; ++i)
        setup.background[i] =
            static_cast<float>(file.number("Background", std::string(1, "rgb"[i]), 0.0));
    setup.sceneSize = file.number("SceneSize", "value", 0.0);
    return setup;
}

std::string caveHost()
{
    if (const char* name = std::getenv("CALVR_HOST_NAME")) return name;
    char name[256] = "";
    gethostname(name, sizeof name - 1);
    return name;
}

} // namespace osgRayTrace::app
