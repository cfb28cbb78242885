// What a build may have beside the page. Enter AR: export { offerAr } from './ar.js';
export const offerAr = null;
