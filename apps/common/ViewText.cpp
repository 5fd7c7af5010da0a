// ViewText.cpp - writes and reads the options of a view. Layer: apps.
// SPDX-License-Identifier: MIT
#include "ViewText.h"

#include "Failure.h"
#include "osgRayTrace/base/NumberText.h"

#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>

namespace osgRayTrace::app
{

using engine::numberText;

namespace
{

std::string textOf(const osg::Vec3d& vector)
{
    return numberText(vector.x()) + ' ' + numberText(vector.y()) + ' ' + numberText(vector.z());
}

/// Returns the next word as a number; nothing if it is none.
std::optional<double> numberFrom(std::istream& words)
{
    std::string word;
    if (!(words >> word)) return std::nullopt;
    const auto number = engine::parseNumber<double>(word);
    return number && std::isfinite(*number) ? number : std::nullopt;
}

std::optional<osg::Vec3d> vectorFrom(std::istream& words)
{
    osg::Vec3d vector;
    for (int i = 0; i < 3; ++i)
    {
        const std::optional<double> number = numberFrom(words);
        if (!number) return std::nullopt;
        vector[i] = *number;
    }
    return vector;
}

/// Takes over the value of an option. Returns whether there is such an option with such a value.
bool take(const std::string& option, std::istream& words, ViewOptions& options)
{
    if (option == "--eye") return (options.eye = vectorFrom(words)).has_value();
    if (option == "--center") return (options.center = vectorFrom(words)).has_value();
    if (option == "--up") return (options.up = vectorFrom(words)).has_value();
    if (option == "--fovy")
    {
        options.fovyDegrees = numberFrom(words);
        return options.fovyDegrees && *options.fovyDegrees > 0.0 && *options.fovyDegrees < 180.0;
    }
    if (option != "--parallel") return false;
    options.height = numberFrom(words);
    return options.height && *options.height > 0.0;
}

} // namespace

std::string viewText(const osg::Matrixd& view, const osg::Matrixd& projection)
{
    osg::Vec3d eye, center, up;
    view.getLookAt(eye, center, up);
    const std::string text =
        "--eye " + textOf(eye) + " --center " + textOf(center) + " --up " + textOf(up);
    double fovy = 0.0, aspect = 0.0, nearest = 0.0, farthest = 0.0;
    if (projection.getPerspective(fovy, aspect, nearest, farthest))
        return text + " --fovy " + numberText(fovy);
    double left = 0.0, right = 0.0, bottom = 0.0, top = 0.0;
    if (projection.getOrtho(left, right, bottom, top, nearest, farthest))
        return text + " --parallel " + numberText(top - bottom);
    return text;
}

Placement withOptions(const Placement& placement, const ViewOptions& options)
{
    Placement result = placement;
    result.eye = options.eye.value_or(placement.eye);
    result.center = options.center.value_or(placement.center);
    result.up = options.up.value_or(placement.up);
    result.fovyDegrees = options.fovyDegrees.value_or(placement.fovyDegrees);
    result.height = options.height.value_or(options.fovyDegrees ? 0.0 : placement.height);
    return result;
}

ViewOptions readViewFile(const std::string& file)
{
    std::ifstream words(file);
    if (!words) throw Failure(kCannotLoad, "cannot read " + file + ": " + std::strerror(errno));
    ViewOptions options;
    std::string option;
    while (words >> option)
        if (!take(option, words, options))
            throw Failure(kCannotLoad,
                          "cannot read " + file + ": '" + option.substr(0, 40) +
                              "' does not begin --eye X Y Z, --center X Y Z, --up X Y Z, --fovy "
                              "DEGREES or --parallel HEIGHT");
    if (!options.any()) throw Failure(kCannotLoad, "cannot read " + file + ": it holds no view");
    return options;
}

} // namespace osgRayTrace::app
