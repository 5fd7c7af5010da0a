// CaveSetup.h - windows, walls and eyes as a configuration has them. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/cave/CaveFile.h"

#include <osg/Matrixd>
#include <osg/Vec4>

#include <string>
#include <vector>

namespace osgRayTrace::app
{

/// Lengths are millimetres, z is up, y forward; angles are degrees: h about z, p about x, r about
/// y.
struct CavePose
{
    osg::Vec3d position;
    double h = 0.0, p = 0.0, r = 0.0;

    /// To the world, from a frame of its own: rotated by r, then p, then h, then moved.
    osg::Matrixd matrix() const;
};

struct CaveWindow
{
    int width = 600, height = 400, left = 0, bottom = 0; ///< pixels
    int displayServer = 0, displayScreen = 0;            ///< of X
    bool decoration = false;
    bool quadBuffer = false;
};

enum class CaveEye
{
    Centre,
    Left,
    Right,
};

/// How the pictures of both eyes come to the one viewport.
enum class CaveStereo
{
    None,      ///< one eye
    LeftRight, ///< beside each other, the left eye's on the left
    TopBottom, ///< the left eye's on top
    QuadBuffer,
    Anaglyph, ///< red and cyan
};

/// A channel with its screen.
struct CaveWall
{
    int index = 0;
    int window = 0;
    int width = 600, height = 400, left = 0, bottom = 0; ///< pixels in the window
    double screenWidth = 600.0, screenHeight = 400.0;
    CavePose screen;          ///< of its centre
    bool followsHead = false; ///< the screen's pose is in the head's frame: HMD
    bool fixedViewer = false; ///< seen from viewer, not from the head
    osg::Vec3d viewer;
    CaveStereo stereo = CaveStereo::None;
    CaveEye eye = CaveEye::Centre; ///< without stereo
    bool swapsEyes = false;
};

struct CaveSetup
{
    std::vector<CaveWindow> windows;
    std::vector<CaveWall> walls;
    CavePose head;
    double separation = 64.0; ///< of the eyes
    bool omniStereo = false;  ///< eyes turn to each wall
    double nearPlane = 10.0, farPlane = 1e7;
    osg::Vec4 background{0.0f, 0.0f, 0.0f, 1.0f};
    double sceneSize = 0.0; ///< of models that are fitted; 0: as they are
};

/// Throws Failure(kCannotLoad) with the file, the line and the name of what is wrong.
CaveSetup caveSetup(const CaveFile& file);

/// CALVR_HOST_NAME, or the machine's.
std::string caveHost();

} // namespace osgRayTrace::app
