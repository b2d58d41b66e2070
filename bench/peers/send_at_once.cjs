// Switches Nagle's algorithm off on every connection that is opened, as the product does on its own.
const net = require("node:net");
const connect = net.Socket.prototype.connect;
net.Socket.prototype.connect = function (...told) {
  this.setNoDelay(true);
  return connect.apply(this, told);
};
