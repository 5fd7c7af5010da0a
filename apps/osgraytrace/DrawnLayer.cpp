// DrawnLayer.cpp - finds where OSG draws, and mixes both pictures. Layer: apps.
// SPDX-License-Identifier: MIT
#include "DrawnLayer.h"

#include "osgRayTrace/film/ToneMap.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace osgRayTrace::app
{

namespace
{

constexpr int kMostSamples = 16;

/// Returns the index-th number of van der Corput's sequence in a base, in [0,1).
double radicalInverse(int index, int base)
{
    double value = 0.0, digit = 1.0;
    for (; index > 0; index /= base)
    {
        digit /= base;
        value += digit * (index % base);
    }
    return value;
}

/// Returns the place of a sample within the pixel, from its middle. The first one is the middle,
/// where the rays of the channels are.
osg::Vec2d sampleOffset(int sample)
{
    if (sample == 0) return {0.0, 0.0};
    const auto centred = [sample](int base)
    { return std::fmod(radicalInverse(sample, base) + 0.5, 1.0) - 0.5; };
    return {centred(2), centred(3)};
}

/// Returns the radiance that each display value stands for.
std::array<float, 256> radianceTable(float exposureEv)
{
    std::array<float, 256> table;
    for (int value = 0; value < 256; ++value)
        table[value] = engine::linearFromSrgb(value / 255.0f) / std::exp2(exposureEv);
    return table;
}

/// Sums the frames of a picture, pixel by pixel.
class FrameSums
{
public:
    FrameSums(const osg::Image& tracedColor, const osg::Image& tracedDepth, float exposureEv)
        : _tracedColor(tracedColor),
          _tracedDepth(tracedDepth),
          _pixels(size_t(tracedColor.s()) * tracedColor.t()),
          _radianceOf(radianceTable(exposureEv)),
          _display(4 * _pixels),
          _radiance(3 * _pixels),
          _drawn(_pixels)
    {
    }

    void add(const osg::Image& color, const osg::Image& depth)
    {
        const unsigned char* values = color.data();
        for (size_t i = 0; i < _pixels; ++i)
        {
            for (int c = 0; c < 4; ++c)
                _display[4 * i + c] =
                    static_cast<uint16_t>(_display[4 * i + c] + values[4 * i + c]);
            if (!isDrawn(color, depth, i)) continue;
            ++_drawn[i];
            for (int c = 0; c < 3; ++c)
                _radiance[3 * i + c] += _radianceOf[values[4 * i + c]];
        }
        ++_frames;
    }

    void resolve(Picture& picture) const
    {
        unsigned char* display = picture.display->data();
        auto* radiance = reinterpret_cast<float*>(picture.radiance->data());
        for (size_t i = 0; i < _pixels; ++i)
        {
            for (int c = 0; c < 4; ++c)
                display[4 * i + c] =
                    static_cast<unsigned char>((_display[4 * i + c] + _frames / 2) / _frames);
            if (!_drawn[i]) continue;
            const float tracedShare = 1.0f - drawnShare(i);
            for (int c = 0; c < 3; ++c)
                radiance[4 * i + c] = tracedShare * radiance[4 * i + c] +
                                      _radiance[3 * i + c] / static_cast<float>(_frames);
            radiance[4 * i + 3] = tracedShare * radiance[4 * i + 3] + drawnShare(i);
        }
    }

    /// Returns the share of the frames in which OSG draws the pixel.
    float drawnShare(size_t pixel) const { return _drawn[pixel] / static_cast<float>(_frames); }

private:
    bool isDrawn(const osg::Image& color, const osg::Image& depth, size_t i) const
    {
        return !std::equal(color.data() + 4 * i, color.data() + 4 * i + 4,
                           _tracedColor.data() + 4 * i) ||
               depthAt(depth, i) != depthAt(_tracedDepth, i);
    }

    static float depthAt(const osg::Image& depth, size_t i)
    {
        return reinterpret_cast<const float*>(depth.data())[i];
    }

    const osg::Image& _tracedColor;
    const osg::Image& _tracedDepth;
    size_t _pixels;
    std::array<float, 256> _radianceOf;
    int _frames = 0;
    std::vector<uint16_t> _display; // sums of RGBA
    std::vector<float> _radiance;   // sums of RGB, over the frames in which OSG draws the pixel
    std::vector<uint8_t> _drawn;    // number of these frames
};

osg::ref_ptr<osg::Image> copyOf(const osg::Image& image)
{
    return new osg::Image(image, osg::CopyOp::DEEP_COPY_ALL);
}

/// Writes a part that is nearer than the traced surface into the channels of its pixel. values are
/// those of the channel.
void replaceFirstHit(const std::string& channel, float* values, const osg::Vec3d& position,
                     double distance, float depth)
{
    if (channel == "depth")
        values[0] = depth;
    else if (channel == "distance")
        values[0] = static_cast<float>(distance);
    else if (channel == "position")
        std::copy(position.ptr(), position.ptr() + 3, values);
    else if (channel == "id")
        values[0] = 0.0f;
    else
        std::fill(values, values + 3, 0.0f);
}

/// Brings the channels up to date. depth is of the frame without a shift.
void compositeChannels(const FrameSums& sums, const osg::Image& depth,
                       const osg::Image& tracedDepth, const Camera& camera, Picture& picture)
{
    const osg::Matrixd worldFromClip = osg::Matrixd::inverse(camera.view * camera.projection);
    const osg::Vec3d eye = osg::Matrixd::inverse(camera.view).getTrans();
    const int width = depth.s(), height = depth.t();
    const auto* now = reinterpret_cast<const float*>(depth.data());
    const auto* traced = reinterpret_cast<const float*>(tracedDepth.data());
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
        {
            const size_t i = size_t(y) * width + x;
            const osg::Vec3d clip(2.0 * (x + 0.5) / width - 1.0, 2.0 * (y + 0.5) / height - 1.0,
                                  2.0 * now[i] - 1.0);
            for (auto& [name, image] : picture.channels)
            {
                const int size = image->getPixelFormat() == GL_RGB ? 3 : 1;
                float* values = reinterpret_cast<float*>(image->data()) + size * i;
                if (name == "error")
                    for (int c = 0; c < size; ++c)
                        values[c] *= 1.0f - sums.drawnShare(i);
                else if (now[i] < traced[i])
                {
                    const osg::Vec3d position = clip * worldFromClip;
                    replaceFirstHit(name, values, position, (position - eye).length(), now[i]);
                }
            }
        }
}

} // namespace

void compositeDrawnParts(const DrawnFrames& frames, const Camera& camera,
                         const RayTraceSettings& settings, Picture& picture)
{
    frames.traced.getDrawable()->setPaused(true);
    const osg::Node::NodeMask mask = frames.scene.getNodeMask();
    frames.scene.setNodeMask(0); // the traced picture alone
    frames.draw();
    frames.scene.setNodeMask(mask);
    const osg::Image& color = *frames.capture.getColorImage();
    const osg::Image& depth = *frames.capture.getDepthImage();
    const osg::ref_ptr<osg::Image> tracedColor = copyOf(color), tracedDepth = copyOf(depth);

    const auto metered = static_cast<float>(picture.statistics.autoExposure);
    FrameSums sums(*tracedColor, *tracedDepth, settings.getExposure() + metered);
    osg::ref_ptr<osg::Image> middleDepth;
    const int samples = std::min(settings.getMaxPasses(), kMostSamples);
    for (int sample = 0; sample < samples; ++sample)
    {
        const osg::Vec2d pixels = sampleOffset(sample);
        frames.viewer.getCamera()->setProjectionMatrix(
            camera.projection * osg::Matrixd::translate(2.0 * pixels.x() / color.s(),
                                                        2.0 * pixels.y() / color.t(), 0.0));
        frames.draw();
        sums.add(color, depth);
        if (sample == 0 && !picture.channels.empty()) middleDepth = copyOf(depth);
    }
    frames.viewer.getCamera()->setProjectionMatrix(camera.projection);
    sums.resolve(picture);
    if (middleDepth) compositeChannels(sums, *middleDepth, *tracedDepth, camera, picture);
}

} // namespace osgRayTrace::app
