// EnvironmentConverter.h - converts an EnvironmentLight to a Light, and its image once. Layer:
// bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/common/ConversionReport.h"
#include "osgRayTrace/scene/Light.h"

#include <osg/Image>
#include <osg/Matrixd>
#include <osg/observer_ptr>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace osgRayTrace
{
class EnvironmentLight;
}

namespace osgRayTrace::engine
{

/// Keeps the image between snapshots as long as its sources are unchanged.
class EnvironmentConverter
{
public:
    /// Converts an environment. Returns nothing, counted and named, if there is no image or it
    /// cannot be read. linear: 8-bit images are decoded from sRGB. The matrix must be invertible;
    /// only its rotation counts.
    std::optional<Light> convert(const EnvironmentLight& source,
                                 const osg::Matrixd& engineFromLocal, bool linear,
                                 const std::string& path, ConversionReport& report);

private:
    /// Identifies an image from which the environment was made.
    struct Source
    {
        osg::observer_ptr<const osg::Image> image;
        unsigned int modified = 0;
        const void* data = nullptr;
    };

    void read(const EnvironmentLight& source, const std::vector<const osg::Image*>& images,
              bool linear, const std::string& name);
    bool isCurrent(const std::vector<const osg::Image*>& images, bool linear) const;
    void remember(const std::vector<const osg::Image*>& images, bool linear);

    std::vector<Source> _sources;
    bool _linear = false;
    std::shared_ptr<const EnvironmentImage> _image;
    Vec3 _brightest{0.0f};    ///< brightest value of the pixels, in each channel
    ConversionCounts _counts; ///< counts of the image, which are reported again with each snapshot
};

} // namespace osgRayTrace::engine
