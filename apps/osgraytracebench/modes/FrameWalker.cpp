// FrameWalker.cpp - frames of a view, their errors and their pictures. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/modes/FrameWalker.h"

#include "apps/common/ErrorMeasures.h"
#include "apps/common/ImageFile.h"
#include "osgRayTrace/base/Parallel.h"

#include <osg/Image>

#include <algorithm>
#include <cmath>
#include <ctime>

namespace osgRayTrace::bench
{

using namespace engine;

namespace
{

double processSeconds()
{
    timespec time;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

} // namespace

FrameWalker::FrameWalker(const std::shared_ptr<const TracedScene>& scene,
                         const std::shared_ptr<Workers>& workers)
{
    inputs.scene = scene;
    inputs.workers = workers;
    inputs.photons = std::make_shared<PhotonPasses>();
    inputs.options.integrator = IntegratorKind::Path;
    inputs.maxPasses = 1 << 20;
}

double FrameWalker::show(const View& view)
{
    rgba.resize(4 * static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height));
    depth.resize(rgba.size() / 4);
    const double begin = processSeconds();
    tracer.trace(inputs, view, {}, rgba.data(), depth.data());
    if (tracer.needsResolve(inputs)) tracer.resolve(rgba.data(), depth.data());
    return processSeconds() - begin;
}

std::vector<float> referenceOf(const std::shared_ptr<const TracedScene>& scene,
                               const std::shared_ptr<Workers>& workers, const View& view,
                               int passes)
{
    RenderSession session(workers);
    session.setScene(scene);
    session.setView(view);
    RenderOptions options;
    options.integrator = IntegratorKind::Path;
    options.seed = 7;
    session.setOptions(options);
    StopRule rule;
    rule.passes = passes;
    session.render(rule);
    return session.resolveRadiance();
}

double relMseOf(const std::vector<float>& picture, const std::vector<float>& reference)
{
    return relMseOf(picture, reference, std::vector<uint8_t>(picture.size() / 4, 1));
}

double relMseOf(const std::vector<float>& picture, const std::vector<float>& reference,
                const std::vector<uint8_t>& marks)
{
    app::ErrorSum sum;
    for (std::size_t i = 0; i < picture.size(); ++i)
        if (i % 4 != 3 && marks[i / 4]) sum.add(picture[i], reference[i]);
    return sum.measures().relMse;
}

void writePicture(const std::string& file, const View& view, const std::vector<float>& picture)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(view.width, view.height, 1, GL_RGB, GL_UNSIGNED_BYTE);
    for (std::size_t i = 0; i < picture.size() / 4; ++i)
        for (std::size_t c = 0; c < 3; ++c)
            image->data()[3 * i + c] = static_cast<unsigned char>(
                255.0 *
                    std::pow(std::min(1.0, std::max(0.0, double(picture[4 * i + c]))), 1.0 / 2.2) +
                0.5);
    app::writeImageFile(file, *image);
}

} // namespace osgRayTrace::bench
