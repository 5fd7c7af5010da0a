// PictureText.h - a text that names a picture, for passes that are made apart. Layer: public API,
// private.
// SPDX-License-Identifier: MIT
#pragma once

#include <osgRayTrace/RayTraceSettings>

#include <osg/Matrixd>

#include <string>

namespace osgRayTrace
{

namespace engine
{
struct Scene;
}

/// The settings that the engine's options are made of. Others act through the scene or on what is
/// made of the sums.
inline constexpr const char* kPictureOptions[] = {"integrator",
                                                  "light-sampling",
                                                  "light-samples",
                                                  "environment-sampling",
                                                  "environment-samples",
                                                  "max-bounces",
                                                  "shadows",
                                                  "terminator-correction",
                                                  "debug-channel",
                                                  "aperture",
                                                  "focus",
                                                  "seed",
                                                  "photons",
                                                  "photon-beams",
                                                  "photon-radius",
                                                  "photon-alpha",
                                                  "radius-schedule",
                                                  "photon-guiding"};

/// What a picture is of.
struct PictureInputs
{
    const engine::Scene& scene;
    const RayTraceSettings& settings;
    osg::Matrixd view, projection;
    int width, height;
    std::string shutterEnd; ///< what is seen as the shutter closes; empty: there is none
};

/// Returns lines of a name and a value each: of all that decides on the bits of a pass.
std::string pictureText(const PictureInputs& picture);

} // namespace osgRayTrace
