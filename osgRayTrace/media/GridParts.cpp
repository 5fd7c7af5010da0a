// GridParts.cpp - the parts of a ray between volumes, and those on which an estimate of their
// transmittance is constant. Layer: media.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/media/FreeFlight.h"
#include "osgRayTrace/media/GridPieces.h"

namespace osgRayTrace::engine
{

bool GridRay::isWithin(float distance) const
{
    for (int i = 0; i < _count; ++i)
    {
        const RayPart& part = span(i).part;
        if (distance >= part.begin && distance < part.end) return true;
    }
    return false;
}

RayPart GridRay::partBetween(float distance) const
{
    if (!_around) return {};
    RayPart part{std::max(distance, _aroundPart.begin), _aroundPart.end};
    for (int i = 0; i < _count; ++i)
        if (span(i).part.begin <= part.begin && part.begin < span(i).part.end)
        {
            part.begin = span(i).part.end;
            i = -1; // any other volume may go on there
        }
    for (int i = 0; i < _count; ++i)
        if (span(i).part.begin > part.begin) part.end = std::min(part.end, span(i).part.begin);
    return part;
}

/// Appends the even parts of a part, with ratio tracking [Novak14, eq. 8], and takes what they take
/// from left. The tracking ends where nothing is left.
void GridRay::trackRatio(RayPart part, NumberStream& numbers, Vec3& left,
                         std::vector<EvenPart>& parts) const
{
    float depth = depthOf(numbers.next()), from = part.begin;
    int tentative = 0;
    for (Pieces piece(*this, part.begin, part.end); piece.advance();)
    {
        float t = piece.begin();
        while (piece.most > 0.0f && depth < piece.most * (piece.end() - t))
        {
            t += depth / piece.most;
            depth = depthOf(numbers.next());
            const Vec3 sigma = at(t, false).sigmaT;
            if (sigma == Vec3(0.0f) && ++tentative < kMostTentative) continue;
            if (t > from) parts.push_back({{from, t}, left});
            from = t;
            left *= glm::max(Vec3(1.0f) - sigma / piece.most, 0.0f);
            constexpr float kLittle = 0.02f, kSurvival = 0.25f;
            if (largestOf(left) < kLittle)
                left = numbers.next() < kSurvival ? left / kSurvival : Vec3(0.0f);
            if (++tentative >= kMostTentative) left = Vec3(0.0f);
            if (left == Vec3(0.0f)) return;
        }
        depth -= piece.most * (piece.end() - t);
    }
    if (part.end > from) parts.push_back({{from, part.end}, left});
}

void GridRay::evenParts(RayPart whole, float margin, NumberStream& numbers,
                        std::vector<EvenPart>& parts) const
{
    std::array<RayPart, kMostVolumes> cores; // of the volumes, without what is near their faces
    std::size_t count = 0;
    for (int i = 0; i < _count; ++i)
    {
        const GridRecord& grid = (*_table)[span(i).grid];
        RayPart core{std::max(span(i).part.begin, whole.begin),
                     std::min(span(i).part.end, whole.end)};
        clipToCube(grid.tileFromEngine, _origin, _direction, core, -margin);
        clipToCube(grid.imageFromEngine, _origin, _direction, core, -margin);
        if (!core.isEmpty()) cores[count++] = core;
    }
    std::sort(cores.begin(), cores.begin() + static_cast<std::ptrdiff_t>(count),
              [](const RayPart& a, const RayPart& b) { return a.begin < b.begin; });
    Vec3 left(1.0f);
    float from = whole.begin;
    for (std::size_t k = 0; k < count; ++k)
    {
        if (cores[k].begin > from) trackRatio({from, cores[k].begin}, numbers, left, parts);
        if (left == Vec3(0.0f)) return;
        from = std::max(from, cores[k].begin);
        if (!(cores[k].end > from)) continue;
        left *= transmittance(from, cores[k].end, numbers);
        if (left == Vec3(0.0f)) return;
        from = cores[k].end;
    }
    if (whole.end > from) trackRatio({from, whole.end}, numbers, left, parts);
}

} // namespace osgRayTrace::engine
