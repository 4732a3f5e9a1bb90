// The parts of Boost.Asio and Boost.Beast that are not templates, compiled once for the server
// (BOOST_ASIO_SEPARATE_COMPILATION, BOOST_BEAST_SEPARATE_COMPILATION) instead of in each file that
// includes them.
#include <boost/asio/impl/src.hpp>
#include <boost/beast/src.hpp>
