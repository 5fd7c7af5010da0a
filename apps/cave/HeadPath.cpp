// HeadPath.cpp - reads poses, and interpolates them. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/cave/HeadPath.h"

#include "apps/common/Failure.h"
#include "osgRayTrace/base/NumberText.h"
#include "osgRayTrace/base/TextFile.h"

#include <cmath>
#include <sstream>

namespace osgRayTrace::app
{

constexpr std::size_t kMostBytes = std::size_t(16) << 20;

HeadPath HeadPath::read(const std::string& file)
{
    const engine::FileText read = engine::readTextFile(file, kMostBytes);
    if (!read.error.empty()) throw Failure(kCannotLoad, "cannot read " + file + ": " + read.error);
    std::istringstream stream(read.text);
    HeadPath path;
    std::string text;
    for (int line = 1; std::getline(stream, text); ++line)
    {
        const auto fail = [&](const char* message)
        { throw Failure(kCannotLoad, file + ":" + std::to_string(line) + ": " + message); };
        std::istringstream numbers(text.substr(0, text.find('#')));
        double v[7];
        int count = 0;
        bool good = true;
        for (std::string word; good && numbers >> word; ++count)
        {
            const auto number = engine::parseNumber<double>(word);
            good = count < 7 && number && std::isfinite(*number);
            if (good) v[count] = *number;
        }
        if (count == 0) continue;
        if (!good || count != 7) fail("a line is seconds x y z h p r, seven numbers");
        if (!path._keys.empty() && !(v[0] > path._keys.back().seconds)) fail("times must rise");
        path._keys.push_back({v[0], {{v[1], v[2], v[3]}, v[4], v[5], v[6]}});
    }
    if (path._keys.empty()) throw Failure(kCannotLoad, file + ": has no poses");
    return path;
}

CavePose HeadPath::at(double seconds) const
{
    if (seconds <= _keys.front().seconds) return _keys.front().pose;
    for (std::size_t i = 1; i < _keys.size(); ++i)
    {
        const Key &a = _keys[i - 1], &b = _keys[i];
        if (seconds > b.seconds) continue;
        const double t = (seconds - a.seconds) / (b.seconds - a.seconds);
        const auto mix = [t](double from, double to) { return from + t * (to - from); };
        return {a.pose.position + (b.pose.position - a.pose.position) * t, mix(a.pose.h, b.pose.h),
                mix(a.pose.p, b.pose.p), mix(a.pose.r, b.pose.r)};
    }
    return _keys.back().pose;
}

} // namespace osgRayTrace::app
