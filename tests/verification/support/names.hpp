// Short names of all rooms, for verification tests.
#pragma once

namespace undula::geometry {}
namespace undula::fom {}
namespace undula::training {}

namespace undula::verification {
using namespace geometry;
using namespace fom;
using namespace training;
} // namespace undula::verification
