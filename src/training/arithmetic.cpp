#include "training/arithmetic.hpp"

#include <filesystem>

#include <ATen/Version.h>
#include <dlfcn.h>
#include <torch/version.h>

namespace clearway::training {
namespace {

/// libtorch tells it in a sentence only: `  - CPU capability usage: AVX2`.
std::string torch_kernels() {
    const std::string configuration = at::show_config();
    const std::string before = "CPU capability usage: ";
    const std::size_t found = configuration.find(before);
    if (found == std::string::npos) return "unknown";
    const std::size_t start = found + before.size();
    return configuration.substr(start, configuration.find('\n', start) - start);
}

/// The file that the Fortran routine of a product of matrices is in.
std::string blas_library() {
    Dl_info found{};
    void* const routine = dlsym(RTLD_DEFAULT, "sgemm_");
    if (routine == nullptr || dladdr(routine, &found) == 0 || found.dli_fname == nullptr) return "unknown";
    std::error_code ignored;
    const std::filesystem::path real = std::filesystem::canonical(found.dli_fname, ignored);
    return ignored ? std::string(found.dli_fname) : real.string();
}

/// OpenBLAS may be loaded for another library while the products come from elsewhere.
std::string openblas_processor(const std::string& library) {
    if (library.find("openblas") == std::string::npos) return "";
    using CoreName = char* (*)();
    const auto name = reinterpret_cast<CoreName>(dlsym(RTLD_DEFAULT, "openblas_get_corename"));
    return name == nullptr ? std::string() : std::string(name());
}

}  // namespace

Arithmetic arithmetic() {
    const std::string library = blas_library();
    return {TORCH_VERSION, torch_kernels(), library, openblas_processor(library)};
}

}  // namespace clearway::training
