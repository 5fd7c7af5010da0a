// FrameWalker.h - traces a view frame by frame, and compares frames with converged pictures.
// Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/photons/PhotonPasses.h"
#include "osgRayTrace/session/view/ViewTracer.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace osgRayTrace::bench
{

/// Holds a view that is path traced frame by frame, with passes that are counted and not timed.
struct FrameWalker
{
    FrameWalker(const std::shared_ptr<const engine::TracedScene>& scene,
                const std::shared_ptr<engine::Workers>& workers);

    /// Traces and shows a frame; returns the CPU seconds of all threads, which hold no time of
    /// other programs on a busy machine.
    double show(const engine::View& view);

    engine::ViewInputs inputs;
    engine::ViewTracer tracer;
    std::vector<uint8_t> rgba;
    std::vector<float> depth;
};

/// Returns a path traced picture of so many passes, of another seed than a FrameWalker's.
std::vector<float> referenceOf(const std::shared_ptr<const engine::TracedScene>& scene,
                               const std::shared_ptr<engine::Workers>& workers,
                               const engine::View& view, int passes);

/// Returns relMSE over RGB of linear RGBA.
double relMseOf(const std::vector<float>& picture, const std::vector<float>& reference);

/// Returns relMSE over RGB of the pixels with a mark.
double relMseOf(const std::vector<float>& picture, const std::vector<float>& reference,
                const std::vector<uint8_t>& marks);

/// Writes linear RGBA of the view's size as a picture for people.
void writePicture(const std::string& file, const engine::View& view,
                  const std::vector<float>& picture);

} // namespace osgRayTrace::bench
