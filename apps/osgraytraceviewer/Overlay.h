// Overlay.h - text over the picture, in pixels of the window. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Camera>
#include <osgGA/GUIActionAdapter>
#include <osgText/Text>

namespace osgRayTrace::app
{

constexpr float kOverlayMargin = 10.0f;    ///< from the border of the window [pixels]
constexpr float kOverlayCharacter = 18.0f; ///< height of characters [pixels]

/// Returns a text on a dark plate, which may change while it is shown.
osg::ref_ptr<osgText::Text> newOverlayText();

/// Returns a camera that draws over everything, in pixels, and is no part of the scene's depth
/// range.
osg::ref_ptr<osg::Camera> newOverlay(osg::Drawable* drawable);

/// Fits the overlay to the viewport of the view that a handler serves, and returns the height of
/// that [pixels]; height if there is none.
double fitOverlay(osg::Camera& overlay, osgGA::GUIActionAdapter& action, double height);

} // namespace osgRayTrace::app
