// DenoiseOidn.h - Open Image Denoise in place of the filter, if the build found it. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/session/image/ResolvedImage.h"

#include <memory>
#include <string>

namespace osgRayTrace::engine
{

/// Runs the library's network for ray traced images on the CPU, with as many threads as the workers
/// have; the affinities of the host's threads stay as they are. The network gets light over alpha,
/// as HDR, with albedo and normal of the first hits, which are free of noise; its result is
/// multiplied by alpha again. Mirrors, glass and lamps have an albedo of 1, as the library's
/// documentation asks for; the background has an albedo of 0. Unlike the filter the network does
/// not vanish as the image converges, because nothing tells it of errors.
///
/// Pixels that are almost empty or are not finite stay as they are, bit for bit. The object keeps
/// device, network and arrays from image to image and makes them anew only for another size. Only
/// one thread may use an object at a time.
class DenoiseOidn
{
public:
    /// Returns whether this build has the library. If it has not, failure() is not empty from the
    /// beginning.
    static bool isBuiltIn();

    DenoiseOidn();
    ~DenoiseOidn();

    /// Sets the surfaces that the pixels of the images to come show. Throws std::bad_alloc.
    void setSurfaces(const std::vector<SurfaceSample>& surfaces, int width, int height,
                     const Workers& workers);

    /// Changes the image's radiance unless something fails. An image of another size than that of
    /// the surfaces stays as it is. Throws std::bad_alloc.
    void filter(ResolvedImage& image, const Workers& workers);

    /// Returns the message of the first failure, which is empty if nothing failed. After a failure
    /// nothing is tried again.
    const std::string& failure() const;

private:
    struct Implementation;
    std::unique_ptr<Implementation> _implementation;
};

} // namespace osgRayTrace::engine
