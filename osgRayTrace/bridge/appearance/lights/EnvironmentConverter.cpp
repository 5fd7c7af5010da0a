// EnvironmentConverter.cpp - places environments in engine space. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/appearance/lights/EnvironmentConverter.h"

#include "osgRayTrace/bridge/appearance/lights/EnvironmentImages.h"
#include "osgRayTrace/bridge/appearance/textures/MissingImages.h"
#include "osgRayTrace/bridge/common/WarnOnce.h"

#include <osgRayTrace/EnvironmentLight>

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

std::vector<const osg::Image*> imagesOf(const EnvironmentLight& source)
{
    std::vector<const osg::Image*> images;
    if (const osg::TextureCubeMap* cube = source.getCubeMap())
        for (unsigned int face = 0; face < 6; ++face)
            images.push_back(cube->getImage(face));
    else
        images.push_back(source.getImage());
    return images;
}

/// Returns the unit vector, even if the vector is too long or too short to be squared. Zero stays
/// zero.
osg::Vec3d unitOf(const osg::Vec3d& v)
{
    const double largest = std::max({std::fabs(v.x()), std::fabs(v.y()), std::fabs(v.z())});
    if (!(largest > 0.0)) return v;
    osg::Vec3d unit = v / largest;
    unit.normalize();
    return unit;
}

/// Returns the axes of the image in engine space, made unit and perpendicular: the zenith first,
/// then the middle.
Mat3 engineFromMap(const osg::Quat& rotation, const osg::Matrixd& engineFromLocal, bool& plain)
{
    osg::Quat unit = rotation / rotation.length();
    const auto axis = [&](const osg::Vec3d& v)
    { return osg::Matrixd::transform3x3(unit * v, engineFromLocal); };
    osg::Vec3d x = axis({1.0, 0.0, 0.0}), y = axis({0.0, 1.0, 0.0}), z = axis({0.0, 0.0, 1.0});
    const double scale = z.length();
    plain = std::fabs(x.length() - scale) < 1e-4 * scale &&
            std::fabs(y.length() - scale) < 1e-4 * scale &&
            std::fabs(x * y) + std::fabs(y * z) + std::fabs(z * x) < 1e-4 * scale * scale;
    z = unitOf(z);
    y = unitOf(y);
    // If axes are nearly parallel, the first round leaves rounding.
    for (int round = 0; round < 2; ++round)
        y = unitOf(y - z * (y * z));
    if (y.length2() < 0.5) // parallel in double: any perpendicular axis will do
        y = unitOf(z ^ (std::fabs(z.x()) < 0.5 ? osg::X_AXIS : osg::Y_AXIS));
    const osg::Vec3d right = y ^ z;
    const osg::Vec3d across = right * (x * right >= 0.0 ? 1.0 : -1.0);
    return Mat3(Vec3(across.x(), across.y(), across.z()), Vec3(y.x(), y.y(), y.z()),
                Vec3(z.x(), z.y(), z.z()));
}

Vec3 brightestOf(const EnvironmentImage& image)
{
    Vec3 brightest(0.0f);
    for (const Vec3& pixel : image.radiance)
        brightest = glm::max(brightest, pixel);
    return brightest;
}

/// Limits the scale so that no pixel gets brighter than kBrightestSky. Returns whether the scale
/// was reduced.
bool limitScale(const Vec3& brightest, Vec3& scale)
{
    bool limited = false;
    for (int c = 0; c < 3; ++c)
    {
        if (double(brightest[c]) * scale[c] <= kBrightestSky) continue;
        scale[c] = kBrightestSky / brightest[c];
        limited = true;
    }
    return limited;
}

/// Says why there is no image.
void reportLost(const std::vector<const osg::Image*>& images, const std::string& name,
                ConversionReport& report)
{
    const auto lost = std::find_if(images.begin(), images.end(), isMissing);
    if (lost != images.end())
    {
        report.missing("missing.environment-image", (*lost)->getFileName(), name + " of",
                       "magenta stands for it unless the scene has another environment");
        return;
    }
    report.warn(
        "skipped.environment-light", name,
        images[0] ? "image is empty, too large, of a format that cannot be read, or its cube is "
                    "not of six equal squares; magenta stands for it unless the scene has another"
                  : "has no image: was its file found? magenta stands for it unless the scene has "
                    "another");
}

} // namespace

std::optional<Light> EnvironmentConverter::convert(const EnvironmentLight& source,
                                                   const osg::Matrixd& engineFromLocal, bool linear,
                                                   const std::string& path,
                                                   ConversionReport& report)
{
    const std::vector<const osg::Image*> images = imagesOf(source);
    const std::string name = "environment light '" + path + "'";
    if (!isCurrent(images, linear)) read(source, images, linear, name);
    if (!_image)
    {
        reportLost(images, name, report);
        return std::nullopt;
    }
    report.add(_counts);
    Light light;
    light.name = source.getName().empty() ? path : source.getName();
    light.kind = LightKind::Environment;
    light.radiance = {source.getScale().x(), source.getScale().y(), source.getScale().z()};
    if (limitScale(_brightest, light.radiance))
        report.warn(
            "repaired.environment-scale", name,
            "its scale makes pixels brighter than 1e30, taken as what makes the brightest that");
    light.environment.image = _image;
    light.environment.visible = source.getVisible();
    bool plain = true;
    light.environment.mapFromEngine =
        glm::transpose(engineFromMap(source.getRotation(), engineFromLocal, plain));
    if (!plain)
        report.warn("approximated.environment-transform", name,
                    "is below a scale that differs by axis: only the rotation counts");
    report.count("converted.environment-light");
    return light;
}

/// Makes the image anew and counts what of it was replaced.
void EnvironmentConverter::read(const EnvironmentLight& source,
                                const std::vector<const osg::Image*>& images, bool linear,
                                const std::string& name)
{
    _image = nullptr;
    _counts.clear();
    _sources.clear(); // should there be no memory, the next call reads anew
    ReplacedPixels replaced;
    if (source.getCubeMap())
        _image = environmentFromCube(images, linear, replaced);
    else if (images[0])
        _image = environmentFromImage(*images[0], linear, replaced);
    const auto note = [&](const char* what, uint64_t number, const char* message)
    {
        if (number == 0) return;
        warnOnce(name + ": " + std::to_string(number) + message);
        _counts[what] = number;
    };
    note("repaired.environment-not-finite", replaced.notFinite,
         " pixels are not finite, taken as black");
    note("repaired.environment-negative", replaced.negative, " pixels are negative, taken as 0");
    note("repaired.environment-too-bright", replaced.tooBright,
         " pixels are above 1e30, taken as that");
    _brightest = _image ? brightestOf(*_image) : Vec3(0.0f);
    remember(images, linear);
}

bool EnvironmentConverter::isCurrent(const std::vector<const osg::Image*>& images,
                                     bool linear) const
{
    if (_linear != linear || images.size() != _sources.size()) return false;
    const auto same = [](const osg::Image* image, const Source& source)
    {
        return image && source.image.get() == image &&
               source.modified == image->getModifiedCount() && source.data == image->data();
    };
    return std::equal(images.begin(), images.end(), _sources.begin(), same);
}

void EnvironmentConverter::remember(const std::vector<const osg::Image*>& images, bool linear)
{
    _linear = linear;
    _sources.clear();
    for (const osg::Image* image : images)
        _sources.push_back(
            {image, image ? image->getModifiedCount() : 0u, image ? image->data() : nullptr});
}

} // namespace osgRayTrace::engine
