#pragma once

#include <string>

namespace clearway::training {

/// What rounds the numbers of a training. Two trainings of one data set and seed have the same bits when all
/// of these agree; a sum in another order differs in its last digit, and training enlarges that.
struct Arithmetic {
    std::string torch;         ///< Version that libtorch's headers name.
    std::string kernels;       ///< Instructions that libtorch chose for this processor: `AVX2`.
    std::string blas;          ///< Library of the matrix products, as the loader found it.
    std::string blas_kernels;  ///< Processor that OpenBLAS chose kernels for; empty for another BLAS.
};

/// Of this process.
Arithmetic arithmetic();

}  // namespace clearway::training
