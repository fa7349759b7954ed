// What the page uses of its libraries, which are not checked themselves.
export class Component {
  constructor(props?: any);
  props: any;
  state: any;
  base: any;
  setState(state: any, callback?: () => void): void;
  componentDidMount(): void;
  componentDidUpdate(props?: any, state?: any): void;
  componentWillUnmount(): void;
  shouldComponentUpdate(props?: any, state?: any): boolean;
}
export const createRef: () => any;
export const h: any;
export const render: (...nodes: any[]) => void;
declare const library: any;
export default library;
