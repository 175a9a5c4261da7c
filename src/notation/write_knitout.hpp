// A Program as the text of a knitout file, version 2.
#pragma once
#include <string>
#include <string_view>

#include "notation/program.hpp"

namespace loopwright {

/// The operation's word in knitout: "knit", "xfer", ... An extension is written by its own text, not by this.
std::string_view name_of(Op op);

/// Writes headers and instructions so that read_knitout gives the same instructions back. A fabric file's
/// settings become `X-` headers, which read_knitout understands and other readers skip; of a fabric file with
/// held or periodic edges the margin is written too, since the cloth is knitted with it.
std::string write_knitout(const Program& program);

}  // namespace loopwright
