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

/// Holds a pose. Lengths are millimetres, z is up, y forward; angles are degrees: h about z, p
/// about x, r about y.
struct CavePose
{
    osg::Vec3d position;
    double h = 0.0, p = 0.0, r = 0.0;

    /// Returns the matrix from the pose's own frame to the world: rotated by r, then p, then h,
    /// then moved.
    osg::Matrixd matrix() const;
};

struct CaveWindow
{
    int width = 600, height = 400, left = 0, bottom = 0; ///< [pixels]
    int displayServer = 0, displayScreen = 0;            ///< X's numbers
    bool decoration = false;
    bool quadBuffer = false;
};

enum class CaveEye
{
    Centre,
    Left,
    Right,
};

/// Tells how the pictures of both eyes come to the one viewport.
enum class CaveStereo
{
    None,      ///< one eye
    LeftRight, ///< beside each other, the left eye's on the left
    TopBottom, ///< the left eye's on top
    QuadBuffer,
    Anaglyph, ///< red and cyan
};

/// Describes a channel with its screen.
struct CaveWall
{
    int index = 0;
    int window = 0;
    int width = 600, height = 400, left = 0, bottom = 0; ///< [pixels] in the window
    double screenWidth = 600.0, screenHeight = 400.0;
    CavePose screen;          ///< pose of the screen's centre
    bool followsHead = false; ///< true: the screen's pose is in the head's frame (HMD)
    bool fixedViewer = false; ///< true: seen from viewer, not from the head
    osg::Vec3d viewer;
    CaveStereo stereo = CaveStereo::None;
    CaveEye eye = CaveEye::Centre; ///< eye of a wall without stereo
    bool swapsEyes = false;
};

struct CaveSetup
{
    std::vector<CaveWindow> windows;
    std::vector<CaveWall> walls;
    CavePose head;
    double separation = 64.0; ///< distance of the eyes [mm]
    bool omniStereo = false;  ///< true: eyes turn to each wall
    double nearPlane = 10.0, farPlane = 1e7;
    osg::Vec4 background{0.0f, 0.0f, 0.0f, 1.0f};
    double sceneSize = 0.0; ///< size of models that are fitted [mm]; 0: as they are
};

/// Returns the setup. Throws Failure(kCannotLoad) with the file, the line and the name of the wrong
/// value.
CaveSetup caveSetup(const CaveFile& file);

/// Returns CALVR_HOST_NAME, or the machine's name.
std::string caveHost();

} // namespace osgRayTrace::app
