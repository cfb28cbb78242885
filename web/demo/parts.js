// What a build may have beside the page.
export { offerAr } from './ar.js';
