#pragma once

#include <kaboum/base/error.h>
