// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/front/connection.h"

#include <algorithm>
#include <cstdio>

#include "ovimap/base/error.h"

namespace ovimap {

namespace {

using std::chrono::milliseconds;

// A body moves at least so much while the server's patience lasts.
constexpr std::uint64_t kPieceBytes = 128 << 10;
constexpr milliseconds kHeartbeat{5000};
// For what is still on its way to a connection that ends: closed at once, it would take the reply
// with it.
constexpr milliseconds kLinger{2000}, kLingerAtEnd{200};
constexpr std::string_view kContinue = "HTTP/1.1 100 Continue\r\n\r\n";

std::string chunk(std::string_view text) {
  char size[24];
  std::snprintf(size, sizeof size, "%zx\r\n", text.size());
  return concat(size, text, "\r\n");
}

}  // namespace

Connection::Connection(std::unique_ptr<Wire> wire, ConnectionHost& host)
    : wire_(std::move(wire)),
      host_(host),
      config_(host.connection_config()),
      client_(client_of(wire_->remote_address())) {}

void Connection::start() {
  be_done_in(config_.patience);
  wire_->shake_hands(then(&Connection::read_head));
}

/// Goes on with `step` where the wire did what it was asked, and ends otherwise.
Wire::Done Connection::then(Step step) {
  return [self = shared_from_this(), step](bool ok, std::size_t) {
    if (self->state_ == State::kClosed) return;
    ok ? (*self.*step)() : self->close();
  };
}

void Connection::enter(State state) {
  state_ = state;
  since_ = Clock::now();
}

void Connection::be_done_in(milliseconds time) {
  wire_->set_deadline(time, [self = shared_from_this()] { self->close(); });
}

void Connection::end() {
  if (state_ == State::kIdle || state_ == State::kHead || state_ == State::kBody) return close();
  ending_ = true;
  unwanted_ = true;
  if (state_ == State::kWriting) be_done_in(config_.patience);
  if (state_ == State::kStreaming && !writing_) pump();
}

void Connection::close() {
  if (state_ == State::kClosed) return;
  enter(State::kClosed);
  unwanted_ = true;
  wire_->close();
  reply_ = {};
  decision_ = {};
  host_.closed(*this);
}

// ----------------------------------------------------------------------------------- requests

void Connection::read_head() {
  const std::size_t end = in_.find("\r\n\r\n");
  if (end != std::string::npos) return take_head(end + 4);
  if (auto refusal = refusal_of_unfinished(in_, config_.head))
    return send(RequestDesk::refused(std::move(*refusal)));
  wire_->read_some(buffer_, [self = shared_from_this()](bool ok, std::size_t bytes) {
    if (self->state_ == State::kClosed) return;
    ok ? self->more_head(bytes) : self->close();
  });
}

void Connection::more_head(std::size_t bytes) {
  if (state_ == State::kIdle) {
    enter(State::kHead);
    be_done_in(config_.patience);
  }
  in_.append(buffer_.data(), bytes);
  read_head();
}

void Connection::take_head(std::size_t bytes) {
  auto parsed = parse_head(std::string_view(in_).substr(0, bytes), config_.head);
  in_.erase(0, bytes);
  if (auto* refusal = std::get_if<HttpReply>(&parsed))
    return send(RequestDesk::refused(std::move(*refusal)));
  request_ = std::move(std::get<HttpRequest>(parsed));
  request_.remote_address = wire_->remote_address();
  decision_ = host_.desk().early(request_);
  body_left_ = request_.content_length.value_or(0);
  const bool expects = request_.header("expect") == "100-continue" && in_.empty();
  if (decision_.refusal && body_left_ > 0 && (expects || !decision_.reads_on)) {
    decision_.refusal->ends_connection = true;
    body_left_ = 0;
  }
  if (body_left_ == 0 || !expects) return take_body();
  wire_->write(kContinue, {}, then(&Connection::take_body));
}

void Connection::take_body() {
  enter(State::kBody);
  const auto bytes = std::min<std::uint64_t>(in_.size(), body_left_);
  if (!decision_.refusal) {
    request_.body.reserve(body_left_);
    request_.body.assign(in_, 0, bytes);
  }
  in_.erase(0, bytes);
  body_left_ -= bytes;
  piece_left_ = 0;
  read_body();
}

void Connection::read_body() {
  if (body_left_ == 0) return decision_.refusal ? send(std::move(*decision_.refusal)) : work();
  if (piece_left_ == 0) {
    piece_left_ = std::min(body_left_, kPieceBytes);
    be_done_in(config_.patience);
  }
  const auto most = std::min<std::uint64_t>(piece_left_, buffer_.size());
  wire_->read_some(std::span(buffer_).first(most),
                   [self = shared_from_this()](bool ok, std::size_t bytes) {
                     if (self->state_ == State::kClosed) return;
                     ok ? self->more_body(bytes) : self->close();
                   });
}

void Connection::more_body(std::size_t bytes) {
  since_ = Clock::now();  // who sends keeps nobody waiting
  if (!decision_.refusal) request_.body.append(buffer_.data(), bytes);
  body_left_ -= bytes;
  piece_left_ -= bytes;
  read_body();
}

void Connection::work() {
  enter(State::kWorking);
  wire_->clear_deadline();
  wire_->wait_for_end([self = shared_from_this()] {
    if (self->state_ == State::kWorking) self->close();
  });
  const bool begun = host_.work(decision_.cost, client_, [self = shared_from_this()] {
    if (self->unwanted_) return self->host_.post([self] { self->close(); });
    HttpReply reply;
    try {
      reply = self->host_.desk().answer(self->request_);
    } catch (const std::exception&) {
      reply = RequestDesk::refused(fault(500, "internal defect; the server goes on"));
    }
    self->host_.post([self, reply = std::move(reply)] {
      if (self->state_ != State::kClosed) self->send(reply);
    });
  });
  if (begun) return;
  HttpReply busy = fault(503, "the server is busy; ask again");
  busy.headers.emplace("Retry-After", "1");
  send(RequestDesk::refused(std::move(busy)));
}

// ------------------------------------------------------------------------------------ replies

void Connection::send(HttpReply reply) {
  if (ending_ || !request_.keep_alive) reply.ends_connection = true;
  enter(State::kWriting);
  reply_ = std::move(reply);
  request_.body = {};
  decision_ = {};
  out_ = reply_head(reply_, request_, !reply_.ends_connection);
  const bool bare = request_.method == "HEAD" || reply_.status == 304 || reply_.stream;
  if (request_.method == "HEAD") reply_.stream = nullptr;
  body_out_ = bare ? std::string_view() : std::string_view(*reply_.body);
  if (ending_) be_done_in(config_.patience);
  write_piece();
}

void Connection::write_piece() {
  if (!ending_) be_done_in(config_.patience);
  const std::string_view piece = body_out_.substr(0, kPieceBytes);
  body_out_.remove_prefix(piece.size());
  wire_->write(out_, piece, then(&Connection::sent));
}

void Connection::sent() {
  out_.clear();
  since_ = Clock::now();
  if (!body_out_.empty()) return write_piece();
  if (reply_.stream) return stream();
  const bool goes_on = !reply_.ends_connection && !ending_;
  reply_ = {};
  request_ = {};
  if (!goes_on) return linger();
  enter(in_.empty() ? State::kIdle : State::kHead);
  be_done_in(in_.empty() ? config_.idle : config_.patience);
  read_head();
}

void Connection::linger() {
  enter(State::kHead);
  in_.clear();
  be_done_in(ending_ ? kLingerAtEnd : kLinger);
  wire_->end_sending(then(&Connection::drain));
}

void Connection::drain() {
  wire_->read_some(buffer_, then(&Connection::drain));
}

// ------------------------------------------------------------------------------------ streams

void Connection::stream() {
  enter(State::kStreaming);
  // Nothing may follow: whatever comes, also the client's end, ends the stream.
  wire_->read_some(buffer_, then(&Connection::close));
  reply_.stream->watch([weak = weak_from_this(), &host = host_, woken = woken_] {
    if (woken->exchange(true)) return;
    host.post([weak] {
      if (const auto self = weak.lock()) self->wake();
    });
  });
  pump();
}

void Connection::wake() {
  *woken_ = false;
  if (state_ == State::kStreaming && !writing_) pump();
}

void Connection::pump() {
  const bool ended = reply_.stream->ended() || ending_;
  const std::string piece = reply_.stream->next();
  if (!piece.empty()) return write_chunk(piece);
  if (ended) {
    writing_ = true;
    out_ = request_.chunks ? "0\r\n\r\n" : "";
    be_done_in(config_.patience);
    return wire_->write(out_, {}, then(&Connection::close));
  }
  wire_->set_deadline(kHeartbeat, [self = shared_from_this()] {
    if (self->state_ == State::kStreaming) self->write_chunk(self->reply_.stream->sign_of_life());
  });
}

void Connection::write_chunk(std::string_view text) {
  writing_ = true;
  out_ = request_.chunks ? chunk(text) : std::string(text);
  be_done_in(config_.patience);
  wire_->write(out_, {}, [self = shared_from_this()](bool ok, std::size_t) {
    if (self->state_ == State::kClosed) return;
    self->writing_ = false;
    ok ? self->pump() : self->close();
  });
}

}  // namespace ovimap
