// LinkModule.cpp - loads the module that connects to render servers. Layer: servers.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/servers/LinkModule.h"

#include "osgRayTrace/servers/ServerAddresses.h"

#if defined(__unix__)
#include <dlfcn.h>
#endif

#include <utility>

namespace osgRayTrace::engine
{

namespace
{

/// Returns the function of the module that opens links; null if there is no module. It lies in the
/// folder osgRayTrace beside the library that has this code, and is never unloaded.
OpenLink loadModule()
{
#if defined(__unix__)
    Dl_info here{};
    if (!dladdr(reinterpret_cast<const void*>(&loadModule), &here) || !here.dli_fname)
        return nullptr;
    const std::string library = here.dli_fname;
    const std::size_t slash = library.rfind('/');
    if (slash == std::string::npos) return nullptr; // never from the working directory
    const std::string folder = library.substr(0, slash);
    void* module = dlopen((folder + "/osgRayTrace/zmq.so").c_str(), RTLD_NOW | RTLD_LOCAL);
    return module ? reinterpret_cast<OpenLink>(dlsym(module, "osgRayTraceOpenLink")) : nullptr;
#else
    return nullptr;
#endif
}

} // namespace

std::shared_ptr<ServerPool> openServers(const std::string& text)
{
    const std::optional<std::vector<std::string>> addresses = parseServers(text);
    if (!addresses || addresses->empty()) return nullptr;
    auto pool = std::make_shared<ServerPool>();
    static const OpenLink open = loadModule();
    if (!open)
    {
        pool->note("the setting servers needs the module osgRayTrace/zmq.so, which is not there "
                   "(OSGRAYTRACE_ZMQ, package osgraytrace-servers)");
        return pool;
    }
    for (const std::string& address : *addresses)
    {
        std::string fault;
        std::unique_ptr<Link> link(open(address, fault));
        if (link)
            pool->add(address, std::move(link));
        else
            pool->note("server " + address + ": " + fault);
    }
    return pool;
}

} // namespace osgRayTrace::engine
