#include "systems/soft/fem/law/elastic_law.h"

#include "systems/soft/fem/law/fung.h"
#include "systems/soft/fem/law/neo_hookean.h"

namespace pliant {

ElasticLaw elastic_law(TissueLaw law) {
  switch (law) {
    case TissueLaw::kCorotational:
      return nullptr;
    case TissueLaw::kNeoHookean:
      return neo_hookean;
    case TissueLaw::kFung:
      return fung;
  }
  return nullptr;
}

}  // namespace pliant
