// ReadableHelp.h - osgViewer's on-screen help on a dark plate. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <osgViewer/ViewerEventHandlers>

namespace osgRayTrace::app
{

/// Shows the help that osgViewer shows; its outlines would close over the letters in small windows,
/// and bright pictures would hide these.
class ReadableHelp : public osgViewer::HelpHandler
{
public:
    using osgViewer::HelpHandler::HelpHandler;

    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action) override;

private:
    bool _readable = false; ///< whether the texts are there and have been changed
};

} // namespace osgRayTrace::app
