// Types of remote.js: a Relief in a worker, or in this thread where there can be no worker.
import type { Relief } from './relief.js';

type Named<K extends keyof Relief> = Relief[K] extends (...args: infer A) => infer R ? { args: A; result: R } : { args: []; result: Relief[K] };
export type Call = [name: keyof Relief, ...args: unknown[]];

export class RemoteRelief {
  private constructor();
  /** `wasm`: as Relief.load has it. `worker`: makes the worker; default: worker.js beside this file. */
  static start(options?: { wasm?: unknown; worker?: () => Worker }): Promise<RemoteRelief>;
  /** Whether the core has a thread of its own. */
  readonly isElsewhere: boolean;
  readonly module: WebAssembly.Module;
  /** Milliseconds of the last calls. */
  readonly ms: number;
  /** A method of Relief, or a getter, by its name. */
  call<K extends keyof Relief>(name: K, ...args: Named<K>['args']): Promise<Named<K>['result']>;
  /** Several in one go, in order. Arrays are copies where the core is elsewhere, else views as Relief gives them.
   * `spare`: a buffer that a picture may come in; it is given away. */
  do(calls: Call[], spare?: ArrayBuffer): Promise<unknown[]>;
  /** Ends the thread. */
  close(): void;
}
