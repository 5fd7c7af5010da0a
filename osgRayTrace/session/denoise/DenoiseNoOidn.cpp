// DenoiseNoOidn.cpp - stands for DenoiseOidn.cpp if the build did not find Open Image Denoise.
// Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/denoise/DenoiseOidn.h"

namespace osgRayTrace::engine
{

struct DenoiseOidn::Implementation
{
    std::string failure = "this build is without Open Image Denoise";
};

bool DenoiseOidn::isBuiltIn()
{
    return false;
}

DenoiseOidn::DenoiseOidn() : _implementation(std::make_unique<Implementation>()) {}
DenoiseOidn::~DenoiseOidn() = default;

void DenoiseOidn::setSurfaces(const std::vector<SurfaceSample>&, int, int, const Workers&) {}

void DenoiseOidn::filter(ResolvedImage&, const Workers&) {}

const std::string& DenoiseOidn::failure() const
{
    return _implementation->failure;
}

} // namespace osgRayTrace::engine
