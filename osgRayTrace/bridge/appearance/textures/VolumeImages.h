// VolumeImages.h - converts three-dimensional images to voxels, each of them once. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Volume.h"

#include <osg/Image>
#include <osg/observer_ptr>

#include <memory>
#include <string>
#include <vector>

namespace osgRayTrace::engine
{

/// The largest number of values that an image of a volume may have: 2 GiB as floats.
constexpr uint64_t kMostVoxelValues = uint64_t(1) << 29;

/// Keeps voxels between snapshots as long as their images are unchanged. Voxels are copies: the
/// application may edit its image while the last snapshot is traced.
class VolumeImages
{
public:
    /// What became of an image.
    struct Result
    {
        std::shared_ptr<const VolumeImage> image; ///< null: see fault
        const char* fault = nullptr;
        uint64_t repaired = 0; ///< values that are not finite, taken as 0, or too large
    };

    /// Returns the voxels of an image. linear: colours are decoded from sRGB. Images of alpha,
    /// luminance and intensity have one value a voxel.
    Result convert(const osg::Image& image, bool linear);

    /// Returns the values of an image alone: the last channel of those that have several. Nothing
    /// is kept of it.
    static Result values(const osg::Image& image);

    /// Forgets the images that were not asked for since the last call.
    void end();

private:
    struct Entry
    {
        osg::observer_ptr<const osg::Image> source;
        unsigned int modified = 0;
        const void* data = nullptr;
        bool linear = false, used = false;
        Result result;
    };

    std::vector<Entry> _entries;
};

} // namespace osgRayTrace::engine
