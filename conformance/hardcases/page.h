// The table case by driver as a page of the report, with pictures of what is called wrong.
#pragma once

#include "conformance/hardcases/table.h"

#include <string>

namespace vernier::conformance::hardcases {

std::string tablePage(const Table& table);

}  // namespace vernier::conformance::hardcases
