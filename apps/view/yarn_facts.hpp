// What is known of the yarn where it cannot be changed in the panel: knitout, and files of cloth.
#pragma once
#include <QString>

#include "cloth_job.hpp"
#include "document.hpp"

namespace loopwright {

// Rich text; empty where nothing is known yet.
QString yarn_facts(const ClothMoment& moment, DocumentKind kind);

}  // namespace loopwright
