// DenoiseOidn.h - Open Image Denoise in place of the filter, where the build found it. Layer:
// session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/session/image/ResolvedImage.h"

#include <memory>
#include <string>

namespace osgRayTrace::engine
{

/// The library's network for ray traced images, on the CPU, with as many threads as the workers
/// have; the affinities of the host's threads stay as they are. It is given light over alpha, as
/// HDR, with albedo and normal of the first hits, which are free of noise; what comes out is
/// multiplied by alpha again. Mirrors, glass and lamps have an albedo of 1, as the library's
/// documentation asks for, the background one of 0. Unlike the filter it does not vanish as the
/// image converges: nothing tells the network of errors.
///
/// Pixels that are almost not there or are not finite stay as they are, bit for bit. Keeps device,
/// network and arrays from image to image; only those of another size are made anew. One thread at
/// a time.
class DenoiseOidn
{
public:
    /// False: this build is without it, and there is a failure from the beginning.
    static bool isBuiltIn();

    DenoiseOidn();
    ~DenoiseOidn();

    /// What is seen in the pixels of the images to come. Throws std::bad_alloc.
    void setSurfaces(const std::vector<SurfaceSample>& surfaces, int width, int height,
                     const Workers& workers);

    /// Changes the image's radiance, but for a failure. Does nothing to an image of another size
    /// than that of the surfaces. Throws std::bad_alloc.
    void filter(ResolvedImage& image, const Workers& workers);

    /// What went wrong; empty: nothing. After a failure nothing is tried again.
    const std::string& failure() const;

private:
    struct Implementation;
    std::unique_ptr<Implementation> _implementation;
};

} // namespace osgRayTrace::engine
