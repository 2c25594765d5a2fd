#include "review/serve_module.h"

#include <httplib.h>

#include <chrono>
#include <cstdio>
#include <mutex>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>

namespace spawnfield::serve_module {
namespace {

constexpr const char* loopback = "127.0.0.1";
constexpr std::size_t most_body = 1 << 20;  // bytes
constexpr std::size_t connections = 8;      // a browser keeps up to six open
constexpr time_t patience = 5;              // s, for a client that sends or reads nothing

std::string random_token()
{
    std::random_device random;
    std::string out;
    for (int i = 0; i < 4; ++i) {
        char text[9];
        std::snprintf(text, sizeof text, "%08x", random());
        out += text;
    }
    return out;
}

/// Compares texts in a time that does not depend on where they differ.
bool is_equal(const std::string& a, const std::string& b)
{
    if (a.size() != b.size()) return false;
    unsigned char difference = 0;
    for (std::size_t i = 0; i < a.size(); ++i) difference = static_cast<unsigned char>(difference | (a[i] ^ b[i]));
    return difference == 0;
}

class Server {
public:
    explicit Server(const LocalServerOptions& options) : options_(options), token_(random_token())
    {
        // The default lets other servers use the same port, whose answers the browser would get. SO_REUSEADDR alone
        // does not; without it, the port of a server that has just ended could not be used.
        server_.set_socket_options([](socket_t socket) {
            const int yes = 1;
            setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
        });
        server_.set_payload_max_length(most_body);
        server_.set_read_timeout(patience);
        server_.set_write_timeout(patience);
        server_.set_keep_alive_timeout(1);  // s; the server ends only when all connections have ended
        server_.new_task_queue = [] { return new httplib::ThreadPool(connections); };
        server_.set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
            return is_refused(request, response) ? httplib::Server::HandlerResponse::Handled
                                                 : httplib::Server::HandlerResponse::Unhandled;
        });
        const auto handle = [this](const httplib::Request& request, httplib::Response& response) {
            answer(request, response);
        };
        server_.Get(".*", handle);
        server_.Post(".*", handle);
    }

    void run()
    {
        port_ = options_.port;
        if (port_ == 0)
            port_ = server_.bind_to_any_port(loopback);
        else if (!server_.bind_to_port(loopback, port_))
            port_ = -1;
        if (port_ < 0)
            throw std::runtime_error("port " + std::to_string(options_.port) +
                                     " cannot be used; is another program using it? Another --port may be free");
        options_.on_start("http://" + host() + "/" + token_ + "/");  // connections wait meanwhile
        std::jthread listener([this] { server_.listen_after_bind(); });
        while (!options_.stop()) std::this_thread::sleep_for(std::chrono::milliseconds(100));
        server_.stop();
    }

private:
    std::string host() const { return loopback + (":" + std::to_string(port_)); }

    /// Returns whether a page of this server sent the request: other pages, for example after a DNS rebinding, have
    /// another host or another origin.
    bool is_own(const httplib::Request& request) const
    {
        const std::string origin = request.get_header_value("Origin");
        return request.get_header_value("Host") == host() && (origin.empty() || origin == "http://" + host());
    }

    bool has_token(const httplib::Request& request) const
    {
        const std::size_t slash = request.path.find('/', 1);
        return slash != request.path.npos && is_equal(request.path.substr(1, slash - 1), token_);
    }

    /// Refuses a request before its body is read: only lengths that are known can be limited.
    bool is_refused(const httplib::Request& request, httplib::Response& response) const
    {
        response.set_header("Cache-Control", "no-store");
        response.set_header("Referrer-Policy", "no-referrer");
        response.set_header("X-Content-Type-Options", "nosniff");
        response.set_header("X-Frame-Options", "DENY");
        response.set_header("Cross-Origin-Resource-Policy", "same-origin");
        const auto refuse = [&](int status, const char* why) {
            response.status = status;
            response.set_header("Connection", "close");
            response.set_content(why, "text/plain");
            return true;
        };
        if (!has_token(request) || !is_own(request))
            return refuse(403, "This address needs its token: use the whole address that spawnfield printed.\n");
        if (request.has_header("Transfer-Encoding") || request.has_header("Content-Encoding"))
            return refuse(411, "A request needs a body of known length that is not compressed.\n");
        return false;
    }

    void answer(const httplib::Request& request, httplib::Response& response)
    {
        const std::lock_guard one_at_a_time(mutex_);
        const std::string path = request.path.substr(request.path.find('/', 1) + 1);
        const WebAnswer answer = options_.answer({request.method, path, request.body});
        response.status = answer.status;
        response.set_content(answer.body, answer.type);
    }

    const LocalServerOptions& options_;
    const std::string token_;
    httplib::Server server_;
    int port_ = 0;
    std::mutex mutex_;
};

}  // namespace

void serve(const LocalServerOptions& options) { Server(options).run(); }

}  // namespace spawnfield::serve_module
