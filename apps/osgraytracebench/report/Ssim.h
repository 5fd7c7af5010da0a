// Ssim.h - the structural similarity of two pictures [Wang04]. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

namespace osgRayTrace::bench
{

/// Returns the mean structural similarity of two pictures, 1 if they are equal: the mean over the
/// pixels and over red, green and blue of
///
///   (2 m_a m_b + C1) (2 s_ab + C2) / ((m_a^2 + m_b^2 + C1) (s_a^2 + s_b^2 + C2))   [Wang04, eq.
///   13]
///
/// with means, variances and covariance under a Gaussian of 11 x 11 pixels and sigma 1.5, C1 =
/// (0.01
/// * 255)^2 and C2 = (0.03 * 255)^2. The pixels are display values, 4 bytes each, of which alpha
/// does not count. Pixels whose Gaussian does not fit into the picture are left out.
double meanSsim(const std::vector<uint8_t>& a, const std::vector<uint8_t>& b, int width,
                int height);

} // namespace osgRayTrace::bench
