// PhaseFunction.cpp - the phase function of water droplets. Layer: media.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/media/PhaseFunction.h"

namespace osgRayTrace::engine
{

Phase dropletPhase(float diameter)
{
    const double d = double(std::clamp(diameter, kSmallestDroplet, kLargestDroplet));
    Phase phase; // [Jendersie23]
    phase.g = static_cast<float>(std::exp(-0.0990567 / (d - 1.67154)));
    phase.draineG = static_cast<float>(std::exp(-2.20679 / (d + 3.91029) - 0.428934));
    phase.draineAlpha = static_cast<float>(std::exp(3.62489 - 8.29288 / (d + 5.52825)));
    phase.draineShare = static_cast<float>(std::exp(-0.599085 / (d - 0.641583) - 0.665888));
    return phase;
}

Phase phaseOf(const Medium& medium)
{
    if (medium.dropletSize > 0.0f) return dropletPhase(medium.dropletSize);
    return std::clamp(medium.anisotropy, -kLargestAnisotropy, kLargestAnisotropy);
}

float meanCosine(const Phase& phase)
{
    const float g2 = phase.draineG * phase.draineG, alpha = phase.draineAlpha;
    const float draine = phase.draineG * (1.0f + alpha * (3.0f + 2.0f * g2) / 5.0f) /
                         (1.0f + alpha * (1.0f + 2.0f * g2) / 3.0f);
    return phase.g + phase.draineShare * (draine - phase.g);
}

/// In s = sqrt(1 + g^2 - 2 g z) the density of z is (1 + alpha z^2) / s^2, but for a factor, and
///
///     F(s) = -b / s - c s + d s^3, b = 1 + alpha a^2 / 4 g^2, c = alpha a / 2 g^2, d = alpha / 12
///     g^2
///
/// is its integral, where a = 1 + g^2. Newton's method inverts F, which grows, within bounds that
/// close in on the result.
float sampleDraine(float g, float alpha, float u)
{
    if (g < 0.0f) return -sampleDraine(-g, alpha, u);
    const double size = std::max(double(g), 1e-3), square = 1.0 + size * size;
    const double scaled = double(alpha) / (2.0 * size * size);
    const auto integral = [&](double s)
    {
        return -(1.0 + 0.5 * scaled * square * square) / s - scaled * square * s +
               scaled / 6.0 * s * s * s;
    };
    double least = 1.0 - size, most = 1.0 + size;
    const double start = integral(least), wanted = start + double(u) * (integral(most) - start);
    double s = (1.0 - size * size) / (1.0 + size * (1.0 - 2.0 * double(u))); // without alpha
    for (int step = 0; step < 60; ++step)
    {
        const double z = (square - s * s) / (2.0 * size), off = integral(s) - wanted;
        (off > 0.0 ? most : least) = s;
        const double next = s - off * s * s / (1.0 + double(alpha) * z * z);
        const double before = s;
        s = next > least && next < most ? next : 0.5 * (least + most);
        if (std::fabs(s - before) <= 1e-10 * s) break;
    }
    return static_cast<float>(std::clamp((square - s * s) / (2.0 * size), -1.0, 1.0));
}

Vec3 sampleDroplets(const Phase& phase, Vec3 direction, float u, float v)
{
    const float share = phase.draineShare;
    const float z = u < share ? sampleDraine(phase.draineG, phase.draineAlpha, u / share)
                              : sampleHenyeyGreenstein(phase.g, (u - share) / (1.0f - share));
    return directionAround(direction, z, v);
}

} // namespace osgRayTrace::engine
