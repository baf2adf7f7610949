/**
 * The server under test: the program that TWEEND names, on a port that the system picks.
 */
import { spawn } from "node:child_process";
import { once } from "node:events";
import { fileURLToPath } from "node:url";

const kAssets = fileURLToPath(new URL("../../../assets", import.meta.url));
const kStart_ms = 30000;

export class ServerProcess {
  #process;
  url = "";

  /**
   * @param {{listen?: string, program?: string}} [options]
   * @returns {Promise<ServerProcess>} once it serves
   */
  static async start({ listen = "127.0.0.1:0", program = process.env.TWEEND } = {}) {
    if (!program) throw new Error("expected the server's program in the environment as TWEEND, e.g. build/release/bin/tweend");
    const server = new ServerProcess();
    const options = ["--listen", listen, "--no-auth", "--assets", kAssets, "--load", "barb", "--play"];
    server.#process = spawn(program, ["serve", ...options], { stdio: ["ignore", "pipe", "inherit"] });
    server.url = await server.#address();
    return server;
  }

  /** It prints its address when the port is open. */
  async #address() {
    let said = "";
    this.#process.stdout.on("data", (bytes) => (said += bytes));
    const late = AbortSignal.timeout(kStart_ms);
    while (!said.includes("\n")) {
      const ended = once(this.#process, "exit", { signal: late }).then(() => Promise.reject(new Error(`the server ended: ${said}`)));
      await Promise.race([once(this.#process.stdout, "data", { signal: late }), ended]);
    }
    return said.trim();
  }

  /** Where it listens, to be given to its successor. */
  get address() {
    return new URL(this.url).host;
  }

  /** Ends it at once, as a crash would. */
  async kill() {
    if (this.#process.exitCode !== null || this.#process.signalCode !== null) return;
    const ended = once(this.#process, "exit");
    this.#process.kill("SIGKILL");
    await ended;
  }

  /**
   * One call, past the page.
   * @param {string} method
   * @param {Record<string, unknown>} [params]
   */
  async call(method, params = {}) {
    const response = await fetch(new URL("/rpc", this.url), {
      method: "POST",
      headers: { "Content-Type": "application/json" },
      body: JSON.stringify({ jsonrpc: "2.0", id: 1, method, params }),
    });
    const answer = await response.json();
    if (answer.error) throw new Error(`${method}: ${answer.error.data?.message ?? answer.error.message}`);
    return answer.result;
  }
}
