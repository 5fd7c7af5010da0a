// ExrError.h - exceptions become sentences before they can reach OSG. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include <exception>
#include <new>
#include <string>

namespace osgRayTrace::engine
{

/// Returns what function returns, or the exception that it throws as one sentence.
template <class Function> std::string caught(const Function& function)
{
    try
    {
        return function();
    }
    catch (const std::bad_alloc&)
    {
        return "there is not enough memory";
    }
    catch (const std::exception& error)
    {
        return error.what();
    }
}

} // namespace osgRayTrace::engine
