// The command line: one file per command in commands/, what commands read in input/, tables and pictures in
// output/.
#pragma once

namespace undula::geometry {}
namespace undula::fom {}
namespace undula::training {}

namespace undula::apps {
using namespace geometry;
using namespace fom;
using namespace training;
} // namespace undula::apps
