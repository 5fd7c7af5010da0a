// Reference.h - the right radiance of a scene, pixel by pixel. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/report/PreparedScene.h"

#include <string>
#include <vector>

namespace osgRayTrace::bench
{

struct Reference
{
    int width = 0, height = 0;
    std::vector<double> mean;     ///< linear RGB, three a pixel
    std::vector<double> variance; ///< variance of mean; zeros if it is a formula's
    std::string origin;           ///< for people: the formula, or how it was rendered
    double meanLuminance = 0.0;   ///< over the picture; linear Rec. 709 weights
    double meanValue = 0.0;       ///< over pixels and colours
};

/// Tells how a reference is rendered: as independent pictures, whose scatter is the variance.
struct ReferencePlan
{
    int seeds = 8;
    int passes = 0; ///< passes of each picture; 0: as many as the first one makes in the seconds
    double seconds = 0.0; ///< seconds of each picture
};

/// Fills in the means over the picture.
void finish(Reference& reference);

/// Returns the formula's mean over each pixel: by Gauss's quadrature unless the scene has a formula
/// for whole pictures.
Reference formulaReference(const ReportScene& scene, int width, const engine::Workers& workers);

/// Returns the reference in the folder's cache if it is one of the same scene, method, size and
/// plan; otherwise renders it and keeps it there. The cache is NAME.json (seeds, passes, mean
/// variance, hash) beside NAME.f64 (mean, then variance, doubles of this machine).
Reference renderedReference(const ReportScene& scene, const PreparedScene& prepared,
                            const ReferencePlan& plan, const std::string& folder);

/// Renders a reference, and takes nothing over from an older version of the program.
Reference newReference(const ReportScene& scene, const PreparedScene& prepared,
                       const ReferencePlan& plan);

/// Returns the part of relMSE that the reference's own noise adds. floor: the radiance whose square
/// is added to that of each pixel.
double noiseOf(const Reference& reference, double floor);

} // namespace osgRayTrace::bench
