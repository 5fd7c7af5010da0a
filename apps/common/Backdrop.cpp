// Backdrop.cpp - reads backdrops, and puts them behind pictures and views. Layer: apps.
// SPDX-License-Identifier: MIT
#include "Backdrop.h"

#include "Failure.h"

#include <osg/Geometry>
#include <osg/Texture2D>
#include <osgDB/ReadFile>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>

namespace osgRayTrace::app
{

namespace
{

std::optional<osg::Vec4> colorFrom(std::string text)
{
    if (text == "black") return osg::Vec4(0, 0, 0, 1);
    if (text == "white") return osg::Vec4(1, 1, 1, 1);
    if (text == "gray" || text == "grey") text = "808080";
    if (!text.empty() && text[0] == '#') text.erase(0, 1);
    if (text.size() != 6 || text.find_first_not_of("0123456789abcdefABCDEF") != std::string::npos)
        return std::nullopt;
    const auto channel = [&text](std::size_t i)
    { return static_cast<float>(std::stoi(text.substr(2 * i, 2), nullptr, 16)) / 255.0f; };
    return osg::Vec4(channel(0), channel(1), channel(2), 1.0f);
}

/// Returns the share of the image that a view of the aspect shows, along x and along y.
osg::Vec2d shownShare(const osg::Image& image, double aspect)
{
    const double own = static_cast<double>(image.s()) / std::max(image.t(), 1);
    return own > aspect ? osg::Vec2d(aspect / own, 1.0) : osg::Vec2d(1.0, own / aspect);
}

/// Returns the colour at a place of the whole picture; x and y in [0,1], y from the bottom.
osg::Vec4 colorAt(const Backdrop& backdrop, double x, double y, double aspect)
{
    if (!backdrop.image)
        return backdrop.bottom + (backdrop.top - backdrop.bottom) * static_cast<float>(y);
    const osg::Vec2d share = shownShare(*backdrop.image, aspect);
    // osg::Image interpolates between the middles of pixels, and clamps at its borders.
    return backdrop.image->getColor(osg::Vec2(static_cast<float>(0.5 + (x - 0.5) * share.x()),
                                              static_cast<float>(0.5 + (y - 0.5) * share.y())));
}

unsigned int byteOf(float value)
{
    const float clamped = value > 0.0f ? std::min(value, 1.0f) : 0.0f; // NaN becomes 0
    return static_cast<unsigned int>(std::lround(255.0f * clamped));
}

osg::ref_ptr<osg::Vec2Array> imageCorners(const osg::Image& image, double aspect)
{
    const osg::Vec2d half = shownShare(image, aspect) * 0.5;
    const auto left = static_cast<float>(0.5 - half.x()), right = 1.0f - left;
    const auto low = static_cast<float>(0.5 - half.y()), high = 1.0f - low;
    osg::ref_ptr<osg::Vec2Array> corners = new osg::Vec2Array;
    for (const osg::Vec2& corner : {osg::Vec2(left, low), osg::Vec2(right, low),
                                    osg::Vec2(left, high), osg::Vec2(right, high)})
        corners->push_back(corner);
    return corners;
}

osg::ref_ptr<osg::Geometry> backdropQuad(const Backdrop& backdrop, double aspect)
{
    osg::ref_ptr<osg::Geometry> quad = new osg::Geometry;
    quad->setUseDisplayList(false);
    quad->setUseVertexBufferObjects(true);
    quad->setDataVariance(osg::Object::DYNAMIC); // see fitBackdrop
    osg::ref_ptr<osg::Vec3Array> corners = new osg::Vec3Array;
    for (const osg::Vec3& corner :
         {osg::Vec3(0, 0, 0), osg::Vec3(1, 0, 0), osg::Vec3(0, 1, 0), osg::Vec3(1, 1, 0)})
        corners->push_back(corner);
    quad->setVertexArray(corners);
    osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array(osg::Array::BIND_PER_VERTEX);
    const osg::Vec4 white(1, 1, 1, 1);
    for (int i = 0; i < 4; ++i)
        colors->push_back(backdrop.image ? white : i < 2 ? backdrop.bottom : backdrop.top);
    quad->setColorArray(colors);
    if (backdrop.image) quad->setTexCoordArray(0, imageCorners(*backdrop.image, aspect));
    quad->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLE_STRIP, 0, 4));
    return quad;
}

} // namespace

Backdrop readBackdrop(const std::string& text)
{
    Backdrop backdrop;
    if (text.empty()) return backdrop;
    backdrop.wanted = true;
    backdrop.transparent = text == "transparent";
    if (backdrop.transparent) return backdrop;
    const std::size_t colon = text.find(':');
    const auto top = colorFrom(text.substr(0, colon));
    const auto bottom = colon == std::string::npos ? top : colorFrom(text.substr(colon + 1));
    if (top && bottom)
    {
        backdrop.top = *top;
        backdrop.bottom = *bottom;
        return backdrop;
    }
    if (!std::filesystem::exists(text))
        throw Failure(kUsage, "--background " + text +
                                  ": not transparent, a colour (#rrggbb, black, white, gray), "
                                  "TOP:BOTTOM, or an image that is there");
    backdrop.image = osgDB::readRefImageFile(text);
    if (!backdrop.image || !backdrop.image->data())
        throw Failure(kCannotLoad, "--background " + text + ": it is no image");
    return backdrop;
}

osg::ref_ptr<osg::Image> backdropImage(const Backdrop& backdrop, const PictureWindow& window,
                                       int width, int height)
{
    if (backdrop.transparent) return nullptr;
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(width, height, 1, GL_RGBA, GL_UNSIGNED_BYTE, 1);
    if (!image->data()) throw std::bad_alloc();
    const double aspect = static_cast<double>(window.fullWidth) / window.fullHeight;
    for (int y = 0; y < height; ++y)
    {
        const double fromTop = window.top + (height - 1 - y) + 0.5;
        for (int x = 0; x < width; ++x)
        {
            const osg::Vec4 color = colorAt(backdrop, (window.left + x + 0.5) / window.fullWidth,
                                            1.0 - fromTop / window.fullHeight, aspect);
            unsigned char* pixel = image->data(x, y);
            for (int c = 0; c < 3; ++c)
                pixel[c] = static_cast<unsigned char>(byteOf(color[c]));
            pixel[3] = 255;
        }
    }
    return image;
}

void makeStraight(osg::Image& display)
{
    unsigned char* const end = display.data() + display.getTotalSizeInBytes();
    for (unsigned char* pixel = display.data(); pixel != end; pixel += 4)
    {
        const unsigned int alpha = pixel[3];
        for (int c = 0; c < 3; ++c)
        {
            const unsigned int value = alpha > 0u ? (pixel[c] * 255u + alpha / 2u) / alpha : 0u;
            pixel[c] = static_cast<unsigned char>(std::min(value, 255u));
        }
    }
}

void putBehind(const Backdrop& backdrop, const osg::Image& radiance, const osg::Vec4& clearColor,
               const PictureWindow& window, osg::Image& display)
{
    const auto* alphas = reinterpret_cast<const float*>(radiance.data());
    const osg::ref_ptr<osg::Image> behind =
        backdropImage(backdrop, window, display.s(), display.t());
    for (int y = 0; y < display.t(); ++y)
    {
        for (int x = 0; x < display.s(); ++x)
        {
            unsigned char* pixel = display.data(x, y);
            const unsigned char* below = behind ? behind->data(x, y) : nullptr;
            const std::size_t index = static_cast<std::size_t>(y) * radiance.s() + x;
            const unsigned int alpha = byteOf(alphas[4 * index + 3]), through = 255u - alpha;
            for (int c = 0; c < 3; ++c)
            {
                const unsigned int old = (through * byteOf(clearColor[c]) + 127u) / 255u;
                const unsigned int own = pixel[c] > old ? pixel[c] - old : 0u;
                const unsigned int value = own + (below ? (through * below[c] + 127u) / 255u : 0u);
                pixel[c] = static_cast<unsigned char>(std::min(value, 255u));
            }
            pixel[3] = static_cast<unsigned char>(below ? 255u : alpha);
        }
    }
    if (!behind) makeStraight(display);
}

osg::ref_ptr<osg::Camera> backdropCamera(const Backdrop& backdrop, double aspect)
{
    osg::ref_ptr<osg::Camera> camera = new osg::Camera;
    camera->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
    camera->setRenderOrder(osg::Camera::NESTED_RENDER);
    camera->setClearMask(0);
    camera->setAllowEventFocus(false);
    camera->setProjectionMatrixAsOrtho2D(0.0, 1.0, 0.0, 1.0);
    osg::StateSet* states = camera->getOrCreateStateSet();
    const auto off = osg::StateAttribute::OFF | osg::StateAttribute::PROTECTED;
    states->setMode(GL_LIGHTING, off);
    states->setMode(GL_DEPTH_TEST, off);
    states->setRenderBinDetails(-1000, "RenderBin"); // before all else
    if (backdrop.image)
    {
        osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(backdrop.image);
        texture->setResizeNonPowerOfTwoHint(false);
        texture->setWrap(osg::Texture::WRAP_S, osg::Texture::CLAMP_TO_EDGE);
        texture->setWrap(osg::Texture::WRAP_T, osg::Texture::CLAMP_TO_EDGE);
        texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR);
        states->setTextureAttributeAndModes(0, texture);
    }
    camera->addChild(backdropQuad(backdrop, aspect));
    return camera;
}

void fitBackdrop(osg::Camera& camera, const Backdrop& backdrop, double aspect)
{
    if (!backdrop.image || camera.getNumChildren() == 0) return;
    auto* quad = dynamic_cast<osg::Geometry*>(camera.getChild(0));
    if (quad) quad->setTexCoordArray(0, imageCorners(*backdrop.image, aspect));
}

} // namespace osgRayTrace::app
