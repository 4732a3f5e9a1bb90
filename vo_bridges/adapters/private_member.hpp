// Reads private members of upstream classes. C++11.
//
// An explicit instantiation may name private members ([temp.explicit]) and pass a pointer to one to
// a friend function. The adapter can thus read the values in effect without patching upstream's
// headers.
//
//   struct SystemTracker {
//     typedef Tracking* System::*Pointer;
//     friend Pointer member_of(SystemTracker);
//   };
//   template struct PrivateMember<SystemTracker, &System::mpTracker>;
//   ... system.*member_of(SystemTracker()) ...
#pragma once

namespace overfly_adapters {

template <typename Tag, typename Tag::Pointer kMember>
struct PrivateMember {
  friend typename Tag::Pointer member_of(Tag) { return kMember; }
};

}  // namespace overfly_adapters
