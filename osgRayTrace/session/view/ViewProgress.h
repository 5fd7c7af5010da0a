// ViewProgress.h - how far a view's image has come, and what a frame took. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/session/RenderProgress.h"
#include "osgRayTrace/session/denoise/DenoiseReport.h"

namespace osgRayTrace::engine
{

/// The stage report says what the stages between accumulation and display did to an image.
struct StageReport
{
    double denoiseSeconds = 0.0; ///< time of the last image that was denoised
    DenoiseReport denoised;      ///< the denoising that the image went through
    /// Share of the pixels to which earlier views add. reprojectSeconds is the time that carrying
    /// these views into the image took.
    double reprojectedShare = 0.0;
    double reprojectSeconds = 0.0;
    float autoEv = 0.0f; ///< exposure that the mean of the image adds [EV]
};

/// A session's progress, and what the view adds to that progress.
struct ViewProgress : RenderProgress
{
    StageReport stages;
};

/// The frame report says what the last frame of a view took.
struct FrameReport
{
    /// Divides the width and height of what is shown. While full resolution fills in, this is the
    /// divider of the reduced image, which is seen where tiles are still missing.
    int divider = 1;
    double seconds = 0.0;      ///< from trace() to recordPresented()
    double traceSeconds = 0.0; ///< the part of seconds in passes and photons
};

} // namespace osgRayTrace::engine
