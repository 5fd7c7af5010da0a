// CameraPath.cpp - reads camera paths and places cameras on them. Layer: apps.
// SPDX-License-Identifier: MIT
#include "CameraPath.h"

#include "Failure.h"
#include "osgRayTrace/base/NumberText.h"

#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <optional>
#include <sstream>

namespace osgRayTrace::app
{

namespace
{

using Point = std::array<double, 8>; ///< time, position, rotation as a quaternion

/// Returns the numbers of a line; nothing if it does not hold eight that are finite.
std::optional<Point> pointOf(const std::string& line)
{
    std::istringstream words(line);
    Point point{};
    std::string word;
    for (double& value : point)
    {
        if (!(words >> word)) return std::nullopt;
        const auto number = engine::parseNumber<double>(word);
        if (!number || !std::isfinite(*number)) return std::nullopt;
        value = *number;
    }
    if (words >> word) return std::nullopt;
    return point;
}

} // namespace

osg::ref_ptr<osg::AnimationPath> readCameraPath(const std::string& file)
{
    const auto refuse = [&file](const std::string& problem)
    { return Failure(kCannotLoad, "cannot read " + file + ": " + problem); };
    std::ifstream stream(file);
    if (!stream) throw refuse(std::strerror(errno));
    osg::ref_ptr<osg::AnimationPath> path = new osg::AnimationPath;
    std::string line;
    for (int number = 1; std::getline(stream, line); ++number)
    {
        if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
        const std::optional<Point> point = pointOf(line);
        if (!point || osg::Quat((*point)[4], (*point)[5], (*point)[6], (*point)[7]).length2() == 0)
            throw refuse("line " + std::to_string(number) +
                         " is not a time, a position and a rotation: 8 numbers");
        const Point& p = *point;
        osg::Quat rotation(p[4], p[5], p[6], p[7]);
        rotation /= rotation.length();
        path->insert(p[0],
                     osg::AnimationPath::ControlPoint(osg::Vec3d(p[1], p[2], p[3]), rotation));
    }
    if (path->empty()) throw refuse("it has no points");
    path->setLoopMode(osg::AnimationPath::NO_LOOPING); // placementOn() makes the loops
    return path;
}

Placement placementOn(const osg::AnimationPath& path, double seconds, double after,
                      double fovyDegrees)
{
    const double period = path.getPeriod();
    // A path that is at its end is not at its beginning yet.
    const double within = period > 0.0 && seconds > period ? std::fmod(seconds, period) : seconds;
    osg::AnimationPath::ControlPoint point;
    path.getInterpolatedControlPoint(path.getFirstTime() + std::min(within + after, period), point);
    Placement placement;
    placement.fovyDegrees = fovyDegrees;
    placement.eye = point.getPosition();
    placement.center = placement.eye + point.getRotation() * osg::Vec3d(0.0, 0.0, -1.0);
    placement.up = point.getRotation() * osg::Vec3d(0.0, 1.0, 0.0);
    return placement;
}

Placement turned(const Placement& placement, const osg::Vec3d& pivot, const osg::Vec3d& axis,
                 double angleRadians)
{
    const osg::Quat turn(angleRadians, axis);
    Placement result = placement;
    result.eye = pivot + turn * (placement.eye - pivot);
    result.center = pivot + turn * (placement.center - pivot);
    result.up = turn * placement.up;
    return result;
}

} // namespace osgRayTrace::app
