// The contacts that one domain has carried out, in their order, and whether they have been rolled back since.
//
// Invariant: a step has no records, or one for each contact.
#pragma once

#include "contact.hpp"

#include <keeler/collision/drift.hpp>

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace keeler::collision {

class DomainContacts {
public:
  void clear() {
    contacts_.clear();
    records_.clear();
    is_rolled_back_.clear();
  }

  void add(const Contact& contact) {
    contacts_.push_back(contact);
    is_rolled_back_.push_back(0);
  }
  /// Adds the record of the last contact.
  void add(const CollisionRecord& record) {
    records_.push_back(record);
    assert(records_.size() == contacts_.size());
  }

  /// Forgets the last contact. Precondition: nothing else depends on it.
  void remove_last() {
    assert(!contacts_.empty() && !is_rolled_back_.back());
    contacts_.pop_back();
    is_rolled_back_.pop_back();
    if (!records_.empty())
      records_.pop_back();
  }
  void roll_back(std::size_t k) {
    assert(!is_rolled_back_[k]);
    is_rolled_back_[k] = 1;
  }

  std::size_t size() const { return contacts_.size(); }
  bool is_rolled_back(std::size_t k) const { return is_rolled_back_[k]; }
  const Contact& operator[](std::size_t k) const { return contacts_[k]; }
  /// Returns the record of a contact, or nullptr if the step is not recorded.
  const CollisionRecord* record(std::size_t k) const { return records_.empty() ? nullptr : &records_[k]; }

  /// Returns the first contact from k on that has not been rolled back, or size().
  std::size_t next_valid(std::size_t k) const {
    while (k < size() && is_rolled_back_[k])
      ++k;
    return k;
  }

  std::size_t bytes() const {
    return contacts_.capacity() * sizeof(Contact) + records_.capacity() * sizeof(CollisionRecord) +
           is_rolled_back_.capacity();
  }

private:
  std::vector<Contact> contacts_;
  std::vector<CollisionRecord> records_;
  std::vector<std::uint8_t> is_rolled_back_;
};

} // namespace keeler::collision
