// SignalledViewer.h - a viewer that ends in order after a signal. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/common/Interruption.h"

#include <osgViewer/Viewer>

#include <optional>

namespace osgRayTrace::app
{

/// Ends when a signal comes, once it is realized, as if Escape had been pressed; a second signal
/// ends the process.
class SignalledViewer : public osgViewer::Viewer
{
public:
    using osgViewer::Viewer::Viewer;

    void realize() override
    {
        osgViewer::Viewer::realize();
        _end.emplace();
    }

    void frame(double simulationTime = USE_REFERENCE_TIME) override
    {
        if (isInterrupted())
            setDone(true);
        else
            osgViewer::Viewer::frame(simulationTime);
    }

    bool checkNeedToDoFrame() override
    {
        return isInterrupted() || osgViewer::Viewer::checkNeedToDoFrame();
    }

private:
    std::optional<OrderlyEnd> _end;
};

} // namespace osgRayTrace::app
