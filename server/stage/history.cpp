#include "server/stage/history.hpp"

#include <algorithm>
#include <utility>

namespace tweend::stage {

History::Step::~Step() {
  // Takes the rest of the chain apart from here, as far as nobody else holds it. Steps are made mutable, so that the one who
  // is last to hold one may take its tail.
  std::shared_ptr<const Step> next = std::move(below);
  while (next && next.use_count() == 1) {
    std::shared_ptr<const Step> after = std::move(const_cast<Step&>(*next).below);
    next = std::move(after);
  }
}

History History::pushed(std::string method, std::vector<Change> changes, std::size_t most) const {
  History next;
  next.top_ = std::make_shared<Step>(std::move(method), std::move(changes), top_);
  next.count_ = std::min(count_ + 1, most);
  next.chain_ = chain_ + 1;
  if (next.chain_ <= 2 * most) return next;
  // Links are immutable: now and then the chain is copied without its forgotten end, which costs O(1) a step on average.
  std::vector<const Step*> kept;
  for (const Step* s = next.top_.get(); s != nullptr && kept.size() < next.count_; s = s->below.get()) kept.push_back(s);
  std::shared_ptr<const Step> chain;
  for (auto at = kept.rbegin(); at != kept.rend(); ++at) {
    chain = std::make_shared<Step>((*at)->method, (*at)->changes, std::move(chain));
  }
  next.top_ = std::move(chain);
  next.chain_ = next.count_;
  return next;
}

History History::popped() const {
  History next;
  next.top_ = top_->below;
  next.count_ = count_ - 1;
  next.chain_ = chain_ - 1;
  return next;
}

}  // namespace tweend::stage
