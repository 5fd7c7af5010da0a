// FormulaReference.cpp - means of a formula over pixels. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/report/Reference.h"

#include "osgRayTrace/base/Parallel.h"

#include <cmath>

namespace osgRayTrace::bench
{

namespace
{

struct Node
{
    double at, weight;
};

/// Returns the nodes of Gauss-Legendre quadrature on [0,1], by Newton's method on the Legendre
/// polynomial.
std::vector<Node> gaussNodes(int count)
{
    std::vector<Node> nodes;
    for (int i = 0; i < count; ++i)
    {
        double x = std::cos(M_PI * (i + 0.75) / (count + 0.5)), slope = 0.0;
        for (int step = 0; step < 50; ++step)
        {
            double p = 1.0, before = 0.0;
            for (int k = 1; k <= count; ++k)
            {
                const double next = ((2.0 * k - 1.0) * x * p - (k - 1.0) * before) / k;
                before = p;
                p = next;
            }
            slope = count * (x * p - before) / (x * x - 1.0);
            x -= p / slope;
        }
        nodes.push_back({0.5 * (1.0 - x), 1.0 / ((1.0 - x * x) * slope * slope)});
    }
    return nodes;
}

} // namespace

Reference formulaReference(const ReportScene& scene, int width, const engine::Workers& workers)
{
    Reference reference;
    reference.width = width;
    reference.height = heightOf(scene, width);
    reference.origin = "formula";
    const std::size_t pixels = static_cast<std::size_t>(width) * reference.height;
    reference.mean.resize(3 * pixels);
    reference.variance.resize(3 * pixels);
    if (scene.pictureFormula)
    {
        reference.mean = scene.pictureFormula(width, reference.height, workers);
        finish(reference);
        return reference;
    }
    const std::vector<Node> nodes = gaussNodes(scene.formulaNodes);
    const osg::Matrixd sceneFromClip = osg::Matrixd::inverse(scene.view * scene.projection);
    const auto row = [&](std::size_t y)
    {
        for (int x = 0; x < width; ++x)
        {
            osg::Vec3d sum;
            for (const Node& u : nodes)
            {
                for (const Node& v : nodes)
                {
                    const double clipX = 2.0 * (x + u.at) / width - 1.0;
                    const double clipY =
                        2.0 * (static_cast<double>(y) + v.at) / reference.height - 1.0;
                    const osg::Vec3d near = osg::Vec3d(clipX, clipY, -1.0) * sceneFromClip;
                    const osg::Vec3d far = osg::Vec3d(clipX, clipY, 1.0) * sceneFromClip;
                    sum += scene.formula(near, far - near) * (u.weight * v.weight);
                }
            }
            for (int c = 0; c < 3; ++c)
                reference
                    .mean[3 * (y * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) +
                          static_cast<std::size_t>(c)] = sum[c];
        }
    };
    workers.forEach(static_cast<std::size_t>(reference.height), row);
    finish(reference);
    return reference;
}

void finish(Reference& reference)
{
    constexpr double kLuminance[3] = {0.2126, 0.7152, 0.0722};
    reference.meanLuminance = reference.meanValue = 0.0;
    for (std::size_t i = 0; i < reference.mean.size(); ++i)
    {
        reference.meanLuminance += kLuminance[i % 3] * reference.mean[i];
        reference.meanValue += reference.mean[i];
    }
    reference.meanLuminance *= 3.0 / static_cast<double>(reference.mean.size());
    reference.meanValue /= static_cast<double>(reference.mean.size());
}

} // namespace osgRayTrace::bench
