// Backdrop.h - what stands behind a picture: a colour, a gradient, an image, or nothing. Layer:
// apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Camera>
#include <osg/Image>
#include <osg/Vec4>

#include <string>

namespace osgRayTrace::app
{

/// Stands behind all that is seen, and lights nothing. Colours are display values.
struct Backdrop
{
    bool wanted = false;
    bool transparent = false;       ///< .png files keep their alpha
    osg::Vec4 top{0, 0, 0, 1};      ///< in the first row
    osg::Vec4 bottom{0, 0, 0, 1};   ///< in the last row
    osg::ref_ptr<osg::Image> image; ///< fills the picture, cut at two of its sides; null: colours
};

/// Reads "transparent", a colour, two colours as TOP:BOTTOM, or the name of an image. Colours are
/// #rrggbb, rrggbb, black, white or gray. "" is no backdrop. Throws Failure(kUsage, kCannotLoad).
Backdrop readBackdrop(const std::string& text);

/// A part of a picture, in pixels from its left and its top.
struct PictureWindow
{
    int left = 0, top = 0, fullWidth = 0, fullHeight = 0;
};

/// Returns the backdrop behind a part of a picture: GL_RGBA, GL_UNSIGNED_BYTE. Null for a
/// transparent one.
osg::ref_ptr<osg::Image> backdropImage(const Backdrop& backdrop, const PictureWindow& window,
                                       int width, int height);

/// Divides the colours of a GL_RGBA, GL_UNSIGNED_BYTE picture by its alpha, as .png files have
/// them.
void makeStraight(osg::Image& display);

/// Replaces the clear colour behind a picture by the backdrop. display: GL_RGBA, GL_UNSIGNED_BYTE,
/// with the clear colour behind it; radiance: the same picture, GL_RGBA, GL_FLOAT, whose alpha says
/// what is seen of the background; window: what display is of a whole picture. Of a transparent
/// backdrop the picture gets straight alpha, as .png files have it.
void putBehind(const Backdrop& backdrop, const osg::Image& radiance, const osg::Vec4& clearColor,
               const PictureWindow& window, osg::Image& display);

/// Returns a camera that fills a view with the backdrop before all else is drawn, to be put beside
/// the scene. aspect: width over height of the view.
osg::ref_ptr<osg::Camera> backdropCamera(const Backdrop& backdrop, double aspect);

/// Fits the camera to a view of another aspect.
void fitBackdrop(osg::Camera& camera, const Backdrop& backdrop, double aspect);

} // namespace osgRayTrace::app
