// The server: on the loopback alone, one thread, and whoever asks must know the token.
//
// A page of another site could make a browser send requests here, so Host must be ours (a name that was pointed to
// 127.0.0.1 is not), Origin and Sec-Fetch-Site, where a browser sends them, must be ours too, and the token stands in each
// path. Only GET is answered, and no body is read. Memory is bounded: so many connections, so many bytes of a request, so
// many frames on their way. A client that takes too long to ask, or to take its answer, is cut off.
#include "common/store.h"
#include "view/view.h"

#include <arpa/inet.h>
#include <microhttpd.h>
#include <netinet/in.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>

enum {
    CONNECTIONS = 24,
    LARGE_MAX = 4,         ///< frames on their way
    REQUEST_BYTES = 16384, ///< of a request's head
    IDLE_SECONDS = 20,
};
static const double ask_seconds = 2, take_seconds = 120;

typedef struct Client {
    struct MHD_Connection *connection; ///< NULL: a free place
    double since;                      ///< s, when it was to begin or to be answered
    bool answered;
} Client;

struct Server {
    View *view;
    struct MHD_Daemon *daemon;
    Client clients[CONNECTIONS + 1];
    int large;
    char host[2][32], origin[2][40]; ///< what Host and Origin may be
};

static Client *client_of(Server *server, struct MHD_Connection *connection) {
    for (int i = 0; i <= CONNECTIONS; i++)
        if (server->clients[i].connection == connection) return &server->clients[i];
    return NULL;
}

static void note_connection(void *context, struct MHD_Connection *connection, void **own,
                            enum MHD_ConnectionNotificationCode code) {
    (void)own;
    Server *server = context;
    const bool begins = code == MHD_CONNECTION_NOTIFY_STARTED;
    Client *client = client_of(server, begins ? NULL : connection);
    if (client) *client = begins ? (Client){connection, console_clock(), false} : (Client){NULL, 0, false};
}

/// The next request on the connection may take its time again.
static void note_completed(void *context, struct MHD_Connection *connection, void **large,
                           enum MHD_RequestTerminationCode code) {
    (void)code;
    Server *server = context;
    if (*large == server) server->large--;
    *large = NULL;
    Client *client = client_of(server, connection);
    if (client) *client = (Client){connection, console_clock(), false};
}

static bool is_one_of(const char *text, const char *a, const char *b) {
    return text && (strcmp(text, a) == 0 || strcmp(text, b) == 0);
}

static enum MHD_Result respond(void *context, struct MHD_Connection *connection, const char *url, const char *method,
                               const char *version, const char *upload, size_t *upload_size, void **large) {
    (void)version, (void)upload;
    Server *server = context;
    const char *length = MHD_lookup_connection_value(connection, MHD_HEADER_KIND, "Content-Length");
    if (*upload_size || (length && strcmp(length, "0") != 0) ||
        MHD_lookup_connection_value(connection, MHD_HEADER_KIND, "Transfer-Encoding"))
        return MHD_NO; // nobody has anything to send here

    Client *client = client_of(server, connection);
    if (client) *client = (Client){connection, console_clock(), true};

    const char *host = MHD_lookup_connection_value(connection, MHD_HEADER_KIND, "Host");
    const char *origin = MHD_lookup_connection_value(connection, MHD_HEADER_KIND, "Origin");
    const char *site = MHD_lookup_connection_value(connection, MHD_HEADER_KIND, "Sec-Fetch-Site");
    const char *token = server->view->token;
    const size_t token_size = strlen(token);
    const bool formed = strlen(url) >= token_size + 2 && url[0] == '/' && url[token_size + 1] == '/';
    unsigned difference = !formed; // the time does not depend on where the first one is
    for (size_t i = 0; formed && i < token_size; i++) difference |= (unsigned)(url[i + 1] ^ token[i]);

    Answer answer;
    if (!is_one_of(host, server->host[0], server->host[1])) answer = answer_text(MHD_HTTP_FORBIDDEN, "wrong host name");
    else if ((origin && !is_one_of(origin, server->origin[0], server->origin[1])) ||
             (site && !is_one_of(site, "same-origin", "none")))
        answer = answer_text(MHD_HTTP_FORBIDDEN, "requests from other sites are refused");
    else if (difference)
        answer = answer_text(MHD_HTTP_FORBIDDEN, "the address lacks the token that singe view printed");
    else if (strcmp(method, "GET") != 0) answer = answer_text(MHD_HTTP_METHOD_NOT_ALLOWED, "only GET");
    else if (server->large >= LARGE_MAX) answer = answer_text(MHD_HTTP_SERVICE_UNAVAILABLE, "busy");
    else answer = answer_to(server->view, url + token_size + 2);

    if (answer.large) {
        server->large++;
        *large = server;
    }

    struct MHD_Response *response = MHD_create_response_from_buffer(
        answer.size, answer.bytes, answer.fixed ? MHD_RESPMEM_PERSISTENT : MHD_RESPMEM_MUST_FREE);
    if (!response) {
        if (!answer.fixed) free(answer.bytes);
        return MHD_NO;
    }

    const char *const headers[][2] = {
        {"Content-Type", answer.type},
        {"Cache-Control", "no-store"},
        {"X-Content-Type-Options", "nosniff"},
        {"Referrer-Policy", "no-referrer"},
        {"Cross-Origin-Resource-Policy", "same-origin"},
        {"Cross-Origin-Opener-Policy", "same-origin"},
        {"Content-Security-Policy", "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; "
                                    "img-src 'self' blob: data:; base-uri 'none'; form-action 'none'; "
                                    "frame-ancestors 'none'"},
    };

    for (size_t i = 0; i < sizeof headers / sizeof *headers; i++)
        MHD_add_response_header(response, headers[i][0], headers[i][1]);
    enum MHD_Result result = MHD_queue_response(connection, answer.status, response);
    MHD_destroy_response(response);
    return result;
}

SingeResult server_open(View *view, Server **out, SingeError *error) {
    Server *server = calloc(1, sizeof *server);
    if (!server) {
        return refuse(error, SINGE_ERROR_MEMORY, "view", -1, "out of memory");
    }

    server->view = view;
    const struct sockaddr_in address = {
        .sin_family = AF_INET, .sin_port = htons((uint16_t)view->port), .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
    server->daemon = MHD_start_daemon(MHD_NO_FLAG, 0, NULL, NULL, respond, server, MHD_OPTION_SOCK_ADDR, &address,
                                      MHD_OPTION_CONNECTION_LIMIT, (unsigned)CONNECTIONS, MHD_OPTION_CONNECTION_TIMEOUT,
                                      (unsigned)IDLE_SECONDS, MHD_OPTION_CONNECTION_MEMORY_LIMIT, (size_t)REQUEST_BYTES,
                                      MHD_OPTION_NOTIFY_CONNECTION, note_connection, server,
                                      MHD_OPTION_NOTIFY_COMPLETED, note_completed, server, MHD_OPTION_END);
    const union MHD_DaemonInfo *port =
        server->daemon ? MHD_get_daemon_info(server->daemon, MHD_DAEMON_INFO_BIND_PORT) : NULL;
    if (!port) {
        const int wanted = view->port;
        server_close(server);
        return refuse(error, SINGE_ERROR_FILE, "view", -1,
                      wanted ? "port %d of this machine (loopback) is in use or not allowed; --port chooses another"
                             : "no port of the loopback can be opened",
                      wanted);
    }

    view->port = port->port;
    static const char *const names[2] = {"127.0.0.1", "localhost"};
    for (int i = 0; i < 2; i++) {
        snprintf(server->host[i], sizeof server->host[i], "%s:%d", names[i], view->port);
        snprintf(server->origin[i], sizeof server->origin[i], "http://%s:%d", names[i], view->port);
    }

    *out = server;
    return SINGE_OK;
}

void server_attend(Server *server, int ms) {
    MHD_run_wait(server->daemon, ms);
    const double now = console_clock();
    for (int i = 0; i <= CONNECTIONS; i++) {
        const Client *client = &server->clients[i];
        if (!client->connection || now - client->since < (client->answered ? take_seconds : ask_seconds)) continue;
        const union MHD_ConnectionInfo *info =
            MHD_get_connection_info(client->connection, MHD_CONNECTION_INFO_CONNECTION_FD);
        if (info) shutdown(info->connect_fd, SHUT_RDWR);
    }
}

void server_close(Server *server) {
    if (!server) return;
    if (server->daemon) MHD_stop_daemon(server->daemon);
    free(server);
}
